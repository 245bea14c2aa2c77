// SIMD vectors of doubles for the kernels, with as many lanes as the instruction set offers, at most eight. Included
// once per instruction set (Highway's foreach_target), hence the unusual guard. The kernels use only operations that
// IEEE 754 rounds correctly, and none is fused (options.cmake), so every instruction set gives the same bits.
#if defined(RIFFLER_BASE_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RIFFLER_BASE_LANES_INL_HPP
#undef RIFFLER_BASE_LANES_INL_HPP
#else
#define RIFFLER_BASE_LANES_INL_HPP
#endif

#include <hwy/highway.h>

#include "base/lanes.hpp"

HWY_BEFORE_NAMESPACE();
namespace riffler::base::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Lanes = hn::CappedTag<double, kLanes>;
using V = hn::Vec<Lanes>;
using M = hn::Mask<Lanes>;
constexpr Lanes kD;

HWY_INLINE int lanes() {
  return static_cast<int>(hn::Lanes(kD));
}
HWY_INLINE V set(double x) {
  return hn::Set(kD, x);
}
HWY_INLINE V zero() {
  return hn::Zero(kD);
}
HWY_INLINE V add(V a, V b) {
  return hn::Add(a, b);
}
HWY_INLINE V sub(V a, V b) {
  return hn::Sub(a, b);
}
HWY_INLINE V mul(V a, V b) {
  return hn::Mul(a, b);
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

}  // namespace riffler::base::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
