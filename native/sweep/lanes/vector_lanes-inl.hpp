// 3D vectors with one vector per lane.
#if defined(RIFFLER_SWEEP_VECTOR_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RIFFLER_SWEEP_VECTOR_LANES_INL_HPP
#undef RIFFLER_SWEEP_VECTOR_LANES_INL_HPP
#else
#define RIFFLER_SWEEP_VECTOR_LANES_INL_HPP
#endif

#include "sweep/lanes/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace riffler::sweep::HWY_NAMESPACE {

using namespace base::HWY_NAMESPACE;

struct V3 {
  V x, y, z;
};

HWY_INLINE V dot(const V3& a, const V3& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE V dot(const V3& a, const double* b) {
  return hn::Add(hn::Add(hn::Mul(a.x, set(b[0])), hn::Mul(a.y, set(b[1]))), hn::Mul(a.z, set(b[2])));
}
/// a × b
HWY_INLINE V3 cross(const V3& a, const double* b) {
  const V x = set(b[0]), y = set(b[1]), z = set(b[2]);
  return {hn::Sub(hn::Mul(a.y, z), hn::Mul(a.z, y)), hn::Sub(hn::Mul(a.z, x), hn::Mul(a.x, z)),
          hn::Sub(hn::Mul(a.x, y), hn::Mul(a.y, x))};
}
HWY_INLINE V3 scaled(const V3& a, V f) {
  return {hn::Mul(a.x, f), hn::Mul(a.y, f), hn::Mul(a.z, f)};
}
/// a − f b
HWY_INLINE V3 less(const V3& a, V f, const V3& b) {
  return {hn::Sub(a.x, hn::Mul(f, b.x)), hn::Sub(a.y, hn::Mul(f, b.y)), hn::Sub(a.z, hn::Mul(f, b.z))};
}
HWY_INLINE V3 choose(M m, const V3& yes, const V3& no) {
  return {pick(m, yes.x, no.x), pick(m, yes.y, no.y), pick(m, yes.z, no.z)};
}
/// a scaled to length 1; (1, 0, 0) if `a` is zero.
HWY_INLINE V3 unit(const V3& a) {
  const V square = dot(a, a);
  const M good = hn::Gt(square, set(1e-300));
  const V scale = hn::Div(set(1), sqrt(pick(good, square, set(1))));
  return choose(good, scaled(a, scale), {set(1), zero(), zero()});
}

}  // namespace riffler::sweep::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
