// Vectors of doubles for the kernels: as many lanes as the instruction set has, at most eight. Included once for every
// instruction set (Highway's foreach_target), hence the unusual guard. Only operations that IEEE 754 rounds correctly
// are used and none is fused (options.cmake), so every instruction set gives the same bits.
#if defined(RIFFLER_SWEEP_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RIFFLER_SWEEP_LANES_INL_HPP
#undef RIFFLER_SWEEP_LANES_INL_HPP
#else
#define RIFFLER_SWEEP_LANES_INL_HPP
#endif

#include <hwy/highway.h>

#include <limits>

#include "sweep/ray_window.hpp"

HWY_BEFORE_NAMESPACE();
namespace riffler::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Lanes = hn::CappedTag<double, kLanes>;
using V = hn::Vec<Lanes>;
using M = hn::Mask<Lanes>;
constexpr Lanes kD;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

HWY_INLINE int lanes() {
  return static_cast<int>(hn::Lanes(kD));
}
HWY_INLINE V set(double x) {
  return hn::Set(kD, x);
}
HWY_INLINE V zero() {
  return hn::Zero(kD);
}
HWY_INLINE M no_lane() {
  return hn::FirstN(kD, 0);
}
HWY_INLINE M both(M a, M b) {
  return hn::And(a, b);
}
HWY_INLINE M either(M a, M b) {
  return hn::Or(a, b);
}
/// a and not b.
HWY_INLINE M without(M a, M b) {
  return hn::AndNot(b, a);
}
HWY_INLINE bool none(M m) {
  return hn::AllFalse(kD, m);
}
HWY_INLINE V pick(M m, V yes, V no) {
  return hn::IfThenElse(m, yes, no);
}
HWY_INLINE V min(V a, V b) {
  return hn::Min(a, b);
}
HWY_INLINE V max(V a, V b) {
  return hn::Max(a, b);
}
HWY_INLINE V abs(V a) {
  return hn::Abs(a);
}
HWY_INLINE V sqrt(V a) {
  return hn::Sqrt(a);
}
/// |a| with the sign of b, for a ≥ 0.
HWY_INLINE V with_sign(V a, V b) {
  return hn::CopySignToAbs(a, b);
}
/// One bit per lane.
HWY_INLINE unsigned bits(M m) {
  unsigned char out[8] = {};
  hn::StoreMaskBits(kD, m, out);
  return out[0];
}
HWY_INLINE M from_bits(unsigned b) {
  const unsigned char in[8] = {static_cast<unsigned char>(b)};
  return hn::LoadMaskBits(kD, in);
}

/// A stretch of each ray; empty where near > far.
struct Stretch {
  V near, far;
};

HWY_INLINE Stretch everything() {
  return {set(-kInfinity), set(kInfinity)};
}
HWY_INLINE Stretch nothing() {
  return {set(kInfinity), set(-kInfinity)};
}
HWY_INLINE Stretch where(M m, Stretch s) {
  return {pick(m, s.near, set(kInfinity)), pick(m, s.far, set(-kInfinity))};
}
HWY_INLINE Stretch common(Stretch a, Stretch b) {
  return {max(a.near, b.near), min(a.far, b.far)};
}

/// {s : q2 s² + 2 q1 s + q0 ≤ 0} for one q2 ≥ 0, by roots that do not cancel. `tangent`: what, as a part of q1²,
/// rounding may have taken from a double root.
HWY_INLINE Stretch at_most_zero(double q2, double per_q2, V q1, V q0, double tangent = 0) {
  const V square = hn::Mul(q1, q1), disc = hn::Sub(square, hn::Mul(set(q2), q0));
  const M real = hn::Ge(disc, hn::Mul(set(-tangent), square));
  const V q = hn::Neg(hn::Add(q1, with_sign(sqrt(max(disc, zero())), q1)));
  const M flat = hn::Eq(q, zero());
  const V b = hn::Div(q0, pick(flat, set(1), q));
  if (q2 > 0) {
    const V a = hn::Mul(q, set(per_q2)), c = pick(flat, zero(), b);
    return where(real, {min(a, c), max(a, c)});
  }
  const V a = with_sign(set(kInfinity), q);
  const M all = both(flat, hn::Le(q0, zero()));
  const Stretch half = where(without(real, flat), {min(a, b), max(a, b)});
  return {pick(all, set(-kInfinity), half.near), pick(all, set(kInfinity), half.far)};
}
HWY_INLINE Stretch at_most_zero(double q2, V q1, V q0) {
  return at_most_zero(q2, 1 / q2, q1, q0);
}

/// {s : 0 ≤ at + slope · s ≤ height}; `per_slope` is 1 / slope, or 0 for a slope of nothing.
HWY_INLINE Stretch slab_by(V at, double per_slope, double height) {
  if (per_slope == 0) return where(both(hn::Ge(at, zero()), hn::Le(at, set(height))), everything());
  const V r = set(-per_slope), a = hn::Mul(at, r), b = hn::Mul(hn::Sub(at, set(height)), r);
  return per_slope > 0 ? Stretch{a, b} : Stretch{b, a};
}
HWY_INLINE Stretch slab(V at, double slope, double height) {
  return slab_by(at, std::abs(slope) < 1e-200 ? 0 : 1 / slope, height);
}

}  // namespace riffler::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
