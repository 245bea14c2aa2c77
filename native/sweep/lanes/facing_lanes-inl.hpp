// The supporting plane of a convex group that faces a point. It shows, without intersecting the ray, that the group
// stays away from the point.
#if defined(RIFFLER_SWEEP_FACING_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RIFFLER_SWEEP_FACING_LANES_INL_HPP
#undef RIFFLER_SWEEP_FACING_LANES_INL_HPP
#else
#define RIFFLER_SWEEP_FACING_LANES_INL_HPP
#endif

#include "sweep/lanes/pose_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace riffler::sweep::HWY_NAMESPACE {

using namespace base::HWY_NAMESPACE;

/// A unit normal out of the group, and the point's height over the supporting plane with that normal.
struct Facing {
  V3 n;
  V height;
};

/// The supporting plane over which the rays' points at `at` are highest. For points outside the group it is
/// perpendicular to the line to the nearest point of the group.
HWY_INLINE Facing facing(const TurningBody& body, const Pose& pose, V at) {
  const V3& o = pose.axis;
  const V3 x{pose.from_tip.x, pose.from_tip.y, hn::Add(pose.from_tip.z, at)};
  const V z = dot(x, o);
  const V3 r = less(x, z, o);
  const V rho = sqrt(dot(r, r));
  // n = (out r / ρ + up o) / d. The flat ends first.
  const V below = hn::Sub(set(body.pieces[0].z0), z), above = hn::Sub(z, set(body.pieces[body.count - 1].z1));
  V height = max(below, above), out = zero(), up = pick(hn::Gt(below, above), set(-1), set(1)), d = set(1);
  // Near the axis, the radial direction is too inaccurate.
  const M off_axis = hn::Gt(rho, set(1e-7 * body.widest));
  for (std::size_t k = 0; k < body.count; ++k) {
    const PieceShape& s = body.pieces[k];
    if (s.round) continue;
    const double lean = -s.slope * s.cosine;
    const V level = hn::Sub(hn::Mul(rho, set(s.cosine)), set(s.support));
    const V h = lean == 0 ? level : hn::Add(level, hn::Mul(z, set(lean)));
    const M better = both(off_axis, hn::Gt(h, height));
    height = pick(better, h, height), out = pick(better, set(s.cosine), out), up = pick(better, set(lean), up);
  }
  for (std::size_t k = 0; k < body.rim_count; ++k) {
    const Rim& rim = body.rims[k];
    const V rise = hn::Sub(z, set(rim.z));
    const M seen = rim.turn1 <= 0   ? both(off_axis, hn::Lt(rise, zero()))
                   : rim.turn0 >= 0 ? both(off_axis, hn::Gt(rise, zero()))
                                    : off_axis;
    if (none(seen)) continue;
    const V far = max(hn::Sub(rho, set(rim.radius)), zero());
    const V distance = sqrt(hn::Add(hn::Mul(far, far), hn::Mul(rise, rise))), h = hn::Sub(distance, set(rim.thick));
    const M touches =
        both(hn::Ge(rise, hn::Mul(set(rim.turn0), distance)), hn::Le(rise, hn::Mul(set(rim.turn1), distance)));
    const M better = both(both(seen, touches), both(hn::Gt(h, height), hn::Gt(distance, set(1e-90))));
    height = pick(better, h, height), out = pick(better, far, out), up = pick(better, rise, up);
    d = pick(better, distance, d);
  }
  const V known = pick(off_axis, rho, set(1)), per = hn::Div(set(1), hn::Mul(d, known));
  return {less(scaled(r, hn::Mul(out, per)), hn::Neg(hn::Mul(hn::Mul(up, known), per)), o), height};
}

}  // namespace riffler::sweep::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
