// The supporting plane of a convex group that looks towards a point: what tells without a hit that the group stays
// away.
#if defined(RIFFLER_SWEEP_FACING_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RIFFLER_SWEEP_FACING_LANES_INL_HPP
#undef RIFFLER_SWEEP_FACING_LANES_INL_HPP
#else
#define RIFFLER_SWEEP_FACING_LANES_INL_HPP
#endif

#include "sweep/pose_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace riffler::HWY_NAMESPACE {

/// A unit normal, out of the group, and the point's height over the plane with that normal that touches the group.
struct Facing {
  V3 n;
  V height;
};

/// The plane that touches the group and over which the rays' points at `at` are highest: of those outside of the group,
/// square to the way to its nearest point.
HWY_INLINE Facing facing(const TurningBody& body, const Pose& pose, V at) {
  const V3& o = pose.axis;
  const V3 x{pose.from_tip.x, pose.from_tip.y, hn::Add(pose.from_tip.z, at)};
  const V z = dot(x, o);
  const V3 r = less(x, z, o);
  const V rho = sqrt(dot(r, r));
  // The flat ends; then n = radial r / ρ + axial o.
  const V below = hn::Sub(set(body.pieces[0].z0), z), above = hn::Sub(z, set(body.pieces[body.count - 1].z1));
  V height = max(below, above), radial = zero(), axial = pick(hn::Gt(below, above), set(-1), set(1));
  const auto offer = [&](M allowed, V h, V along_r, V along_o) {
    const M better = both(allowed, hn::Gt(h, height));
    height = pick(better, h, height), radial = pick(better, along_r, radial), axial = pick(better, along_o, axial);
  };
  // Near the axis, the direction away from it is not known well enough.
  const M off_axis = hn::Gt(rho, set(1e-7 * body.widest));
  for (std::size_t k = 0; k < body.count; ++k) {
    const PieceShape& s = body.pieces[k];
    if (s.round) continue;
    const double lean = -s.slope * s.cosine;
    const V h = hn::Sub(hn::Add(hn::Mul(rho, set(s.cosine)), hn::Mul(z, set(lean))), set(s.support));
    offer(off_axis, h, set(s.cosine), set(lean));
  }
  for (std::size_t k = 0; k < body.rim_count; ++k) {
    const Rim& rim = body.rims[k];
    const V up = hn::Sub(z, set(rim.z));
    if ((rim.turn1 <= 0 && none(hn::Lt(up, zero()))) || (rim.turn0 >= 0 && none(hn::Gt(up, zero())))) continue;
    const V out = max(hn::Sub(rho, set(rim.radius)), zero());
    const V d = sqrt(hn::Add(hn::Mul(out, out), hn::Mul(up, up))), per_d = hn::Div(set(1), max(d, set(1e-100)));
    const V lean = hn::Mul(up, per_d);
    const M touches = both(both(hn::Ge(lean, set(rim.turn0)), hn::Le(lean, set(rim.turn1))), hn::Gt(d, set(1e-90)));
    offer(both(off_axis, touches), hn::Sub(d, set(rim.thick)), hn::Mul(out, per_d), lean);
  }
  const V scale = hn::Div(radial, max(rho, set(1e-150)));
  return {less(scaled(r, scale), hn::Neg(axial), o), height};
}

}  // namespace riffler::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
