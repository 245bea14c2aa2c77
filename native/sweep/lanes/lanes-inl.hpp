// Interval arithmetic on straight rays, as many rays at a time as there are lanes.
#if defined(RIFFLER_SWEEP_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RIFFLER_SWEEP_LANES_INL_HPP
#undef RIFFLER_SWEEP_LANES_INL_HPP
#else
#define RIFFLER_SWEEP_LANES_INL_HPP
#endif

#include "base/lanes-inl.hpp"
#include "geom/math.hpp"
#include "sweep/ray_window.hpp"

HWY_BEFORE_NAMESPACE();
namespace riffler::sweep::HWY_NAMESPACE {

using namespace base::HWY_NAMESPACE;

/// An interval of each ray; empty if near > far.
struct RayIntervals {
  V near, far;
};

HWY_INLINE RayIntervals everything() {
  return {set(-kInfinity), set(kInfinity)};
}
HWY_INLINE RayIntervals nothing() {
  return {set(kInfinity), set(-kInfinity)};
}
HWY_INLINE RayIntervals where(M m, RayIntervals s) {
  return {pick(m, s.near, set(kInfinity)), pick(m, s.far, set(-kInfinity))};
}
HWY_INLINE RayIntervals common(RayIntervals a, RayIntervals b) {
  return {max(a.near, b.near), min(a.far, b.far)};
}

/// {s : q2 s² + 2 q1 s + q0 ≤ 0} for one q2 ≥ 0, with a root formula that avoids cancellation. `tangent`: a negative
/// discriminant counts as a double root up to this fraction of q1², because it may be due to rounding.
HWY_INLINE RayIntervals at_most_zero(double q2, double per_q2, V q1, V q0, double tangent = 0) {
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
  const RayIntervals half = where(without(real, flat), {min(a, b), max(a, b)});
  return {pick(all, set(-kInfinity), half.near), pick(all, set(kInfinity), half.far)};
}
HWY_INLINE RayIntervals at_most_zero(double q2, V q1, V q0) {
  return at_most_zero(q2, 1 / q2, q1, q0);
}

/// {s : 0 ≤ at + slope · s ≤ height}; `per_slope` is 1 / slope, or 0 for slope 0.
HWY_INLINE RayIntervals slab_by(V at, double per_slope, double height) {
  if (per_slope == 0) return where(both(hn::Ge(at, zero()), hn::Le(at, set(height))), everything());
  const V r = set(-per_slope), a = hn::Mul(at, r), b = hn::Mul(hn::Sub(at, set(height)), r);
  return per_slope > 0 ? RayIntervals{a, b} : RayIntervals{b, a};
}
HWY_INLINE RayIntervals slab(V at, double slope, double height) {
  return slab_by(at, std::abs(slope) < 1e-200 ? 0 : 1 / slope, height);
}

}  // namespace riffler::sweep::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
