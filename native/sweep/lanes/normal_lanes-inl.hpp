// Normals of a swept volume at ends of rays, many ends at a time.
#if defined(RIFFLER_SWEEP_NORMAL_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RIFFLER_SWEEP_NORMAL_LANES_INL_HPP
#undef RIFFLER_SWEEP_NORMAL_LANES_INL_HPP
#else
#define RIFFLER_SWEEP_NORMAL_LANES_INL_HPP
#endif

#include "sweep/lanes/pose_lanes-inl.hpp"
#include "sweep/lanes/vector_lanes-inl.hpp"
#include "sweep/swept_normals.hpp"

HWY_BEFORE_NAMESPACE();
namespace riffler::sweep::HWY_NAMESPACE {

using namespace base::HWY_NAMESPACE;

/// A normal of a tool's surface: components away from its axis and along it.
struct Across {
  V out, up;
};
HWY_INLINE Across choose(M m, const Across& yes, const Across& no) {
  return {pick(m, yes.out, no.out), pick(m, yes.up, no.up)};
}

/// The two surfaces of a group nearest to the points of its half-plane: their normals and distances, and the curvature
/// of the nearest one's profile.
struct Nearest {
  Across normal, second;
  V off, second_off, bend;

  HWY_INLINE void add(const Across& n, V aside, V past, double curvature) {
    const V distance = sqrt(hn::Add(hn::Mul(aside, aside), hn::Mul(past, past)));
    const M nearer = hn::Lt(distance, off), next = hn::Lt(distance, second_off);
    second = choose(nearer, normal, choose(next, n, second));
    second_off = pick(nearer, off, pick(next, distance, second_off));
    normal = choose(nearer, n, normal), off = pick(nearer, distance, off), bend = pick(nearer, set(curvature), bend);
  }
};

/// Distance outside a range, 0 inside it.
HWY_INLINE V beyond(V x, double low, double high) {
  return max(max(zero(), hn::Sub(set(low), x)), hn::Sub(x, set(high)));
}

HWY_INLINE Nearest nearest(const SweptSurface& surface, V rho, V z) {
  const Across up{zero(), set(1)};
  Nearest out{up, up, set(kInfinity), set(kInfinity), zero()};
  for (std::size_t k = 0; k < surface.count; ++k) {
    const PieceShape& s = surface.pieces[k];
    const V past = beyond(z, s.z0, s.z1);
    if (s.round) {
      // The normal of the end of the arc, not of its circle beyond: `edge` below compares with it.
      const V on = min(max(z, set(s.z0)), set(s.z1));
      const V x = max(hn::Sub(rho, set(s.e)), zero()), y = hn::Sub(on, set(s.zc));
      const V length = sqrt(hn::Add(hn::Mul(x, x), hn::Mul(y, y)));
      const M good = hn::Gt(length, zero());
      const V whole = pick(good, length, set(1));
      out.add({pick(good, hn::Div(x, whole), set(1)), hn::Div(y, whole)}, hn::Sub(length, set(s.r)), past, 1 / s.r);
    } else {
      const V wall = hn::Add(set(s.r0), hn::Mul(set(s.slope), hn::Sub(z, set(s.z0))));
      out.add({set(s.cosine), set(-s.slope * s.cosine)}, hn::Mul(hn::Sub(rho, wall), set(s.cosine)), past, 0);
    }
    if (k == 0 && s.cut0) out.add({zero(), set(-1)}, hn::Sub(z, set(s.z0)), beyond(rho, 0, s.r0), 0);
    if (k + 1 == surface.count && s.cut1) out.add({zero(), set(1)}, hn::Sub(z, set(s.z1)), beyond(rho, 0, s.r1), 0);
  }
  return out;
}

HWY_INLINE V3 axis_at(const SweptSurface& b, const SweptEnds& ends, std::size_t k, V t) {
  if (b.wide)
    return {hn::LoadU(kD, &ends.axis[0][k]), hn::LoadU(kD, &ends.axis[1][k]), hn::LoadU(kD, &ends.axis[2][k])};
  if (b.angle == 0) return {set(b.axis[0]), set(b.axis[1]), set(b.axis[2])};
  const V turn = hn::Mul(set(b.angle), hn::Sub(t, set(b.middle)));
  const V c = cosine(turn), s = sine(turn);
  const auto at = [&](int i) { return hn::Add(hn::Mul(c, set(b.axis[i])), hn::Mul(s, set(b.side[i]))); };
  return {at(0), at(1), at(2)};
}

/// The unit vector of `a`, which is square to the axis; any that is if the square of `a` is at most `least`.
HWY_INLINE V3 square_to(const V3& axis, const V3& a, V least) {
  const M flat = hn::Lt(abs(axis.x), set(0.5));
  const V3 any{zero(), pick(flat, axis.z, zero()), pick(flat, hn::Neg(axis.y), zero())};
  const V3 other{hn::Neg(axis.z), zero(), axis.x};
  return choose(hn::Gt(dot(a, a), least), unit(a), unit(choose(flat, any, other)));
}

/// The outward unit normal of the swept volume. `on_axis`: mm from the axis, where a point counts as on it.
HWY_INLINE V3 swept_normal(const SweptSurface& b, const SweptEnds& ends, std::size_t k, double on_axis) {
  const V t = hn::LoadU(kD, &ends.t[k]);
  const V3 axis = axis_at(b, ends, k, t);
  const auto from_tip = [&](const auto& p, int i) {
    return hn::Sub(hn::LoadU(kD, &p[k]), hn::Add(set(b.tip[i]), hn::Mul(t, set(b.way[i]))));
  };
  const V3 w{from_tip(ends.u, 0), from_tip(ends.v, 1), from_tip(ends.s, 2)};
  const V z = dot(w, axis);
  const V3 aside = less(w, z, axis);
  const V rho = sqrt(dot(aside, aside));
  const V3 back = cross(w, b.spin);
  const V3 velocity{hn::Sub(set(b.way[0]), back.x), hn::Sub(set(b.way[1]), back.y), hn::Sub(set(b.way[2]), back.z)};
  const V rounding = set(1e-9), square = dot(velocity, velocity), speed = sqrt(square), rise = dot(velocity, axis);
  const M starts = hn::Le(t, rounding), stops = hn::Ge(t, hn::Sub(set(1), rounding));
  // On the axis, such as at a cone's apex, the tool has sides all around. Backwards where the move starts, forwards
  // where it stops, they are not covered. Between, the apex sweeps an edge, where n · v = 0 for a normal between that
  // of its lowest point and that of the side ahead if the tool rises, behind if it falls. t is rounded, see below.
  const M off_axis = hn::Gt(rho, hn::Add(set(on_axis), hn::Mul(set(b.angle == 0 ? 1e-9 : 0), speed)));
  const V whole = pick(off_axis, rho, set(1));
  const V3 ahead = less(velocity, rise, axis);
  const M behind = either(starts, without(hn::Le(rise, zero()), stops));
  const V3 at_apex = square_to(axis, scaled(ahead, pick(behind, set(-1), set(1))), hn::Mul(set(1e-16), square));
  const V3 radial =
      choose(off_axis, {hn::Div(aside.x, whole), hn::Div(aside.y, whole), hn::Div(aside.z, whole)}, at_apex);
  const Nearest at = nearest(b, rho, z);
  const auto in_space = [&](const Across& n) {
    const V3 out = scaled(radial, n.out), up = scaled(axis, n.up);
    return V3{hn::Add(out.x, up.x), hn::Add(out.y, up.y), hn::Add(out.z, up.z)};
  };
  const V3 n = in_space(at.normal);
  const V slide = dot(n, velocity);
  const M still = hn::Not(hn::Gt(abs(slide), zero()));
  // t is a multiple of 2⁻³⁰, so on a long move a point on an edge is a little off both sides.
  const V size = hn::Add(hn::Add(rho, abs(z)), hn::Mul(set(2), speed));
  const M close = hn::Le(at.second_off, hn::Add(at.off, hn::Mul(rounding, size)));
  const V3 second = in_space(at.second);
  const V second_slide = dot(second, velocity);
  // The swept surface faces backwards where the move starts, forwards where it stops. On an edge one side may not.
  const M unseen = either(both(starts, both(hn::Gt(slide, zero()), hn::Le(second_slide, zero()))),
                          both(stops, both(hn::Lt(slide, zero()), hn::Ge(second_slide, zero()))));
  const V3 at_end = choose(both(close, unseen), second, n);
  const M ends_there = either(either(starts, stops), still);
  if (none(hn::Not(ends_there))) return at_end;
  // During the move the swept surface is where n · v = 0 (3.1); on an edge, for a normal between those of its two
  // sides.
  const V3 arm = choose(off_axis, aside, at_apex);
  const V3 around{hn::Sub(hn::Mul(axis.y, arm.z), hn::Mul(axis.z, arm.y)),
                  hn::Sub(hn::Mul(axis.z, arm.x), hn::Mul(axis.x, arm.z)),
                  hn::Sub(hn::Mul(axis.x, arm.y), hn::Mul(axis.y, arm.x))};
  const V3 swept{hn::Sub(hn::Mul(around.y, velocity.z), hn::Mul(around.z, velocity.y)),
                 hn::Sub(hn::Mul(around.z, velocity.x), hn::Mul(around.x, velocity.z)),
                 hn::Sub(hn::Mul(around.x, velocity.y), hn::Mul(around.y, velocity.x))};
  const V length = sqrt(dot(swept, swept));
  const M firm = hn::Gt(length, hn::Mul(hn::Mul(rounding, speed), whole));
  // The normal is between those of the two sides, and may be perpendicular to the radial direction.
  const V3 between{hn::Add(n.x, second.x), hn::Add(n.y, second.y), hn::Add(n.z, second.z)};
  const V sign = with_sign(set(1), dot(swept, choose(close, between, arm)));
  const V3 turned = choose(firm, scaled(swept, hn::Div(sign, pick(firm, length, set(1)))), n);
  // One of the sides may slide along itself, as the flat end of a tool on a level move does. Where two sides join
  // smoothly both do; there `swept` may consist of rounding, and then it is not between them.
  const V least = hn::Sub(dot(n, second), rounding);
  const M inside = both(hn::Ge(dot(turned, n), least), hn::Ge(dot(turned, second), least));
  const M slides = hn::Lt(hn::Mul(slide, second_slide), hn::Mul(rounding, square));
  const M edge = both(both(close, slides), inside);
  if (b.angle == 0) {
    // On a smooth side n · v is not 0 because t is rounded. The normal turns by S v per unit of t, where S is the
    // side's shape operator: follow it to where n · v = 0. Ends on other places than edges arise at t = 0 and 1, and on
    // a move as short as rounding anywhere between.
    const V meridian = dot(velocity, in_space({hn::Neg(at.normal.up), at.normal.out}));
    const V ring = hn::Div(dot(velocity, around), whole);
    const V turn_m = hn::Mul(at.bend, meridian);
    const V turn_r = hn::Mul(pick(off_axis, hn::Div(at.normal.out, whole), at.bend), ring);
    const V rate = hn::Add(hn::Mul(turn_m, meridian), hn::Mul(turn_r, ring));
    const V late = hn::Add(hn::Mul(rounding, square), hn::Mul(set(1e-13), hn::Mul(size, speed)));  // 2 δt v²
    const M smooth = without(hn::Le(hn::Mul(abs(slide), square), hn::Mul(late, rate)), edge);
    const V delay = hn::Div(slide, pick(hn::Gt(rate, zero()), rate, set(1)));
    const V3 moved = unit(less(less(n, hn::Mul(delay, turn_m), in_space({hn::Neg(at.normal.up), at.normal.out})),
                               hn::Div(hn::Mul(delay, turn_r), whole), around));
    return choose(ends_there, at_end, choose(edge, turned, choose(smooth, moved, n)));
  }
  // On a smooth side of a turning move, t is nearly right; remove what remains of n · v.
  const M smooth = without(hn::Le(abs(slide), hn::Mul(set(0.15), speed)), edge);
  const V3 level = unit(less(n, hn::Div(slide, pick(still, set(1), square)), velocity));
  return choose(ends_there, at_end, choose(smooth, level, turned));
}

/// The octahedral map (span.hpp) of the normals out of the material, in the world.
HWY_INLINE void map_normal(const V3& swept, int world, V& u, V& v) {
  const V local[3] = {swept.x, swept.y, swept.z};
  const V3 n{local[world % 3], local[(world + 1) % 3], local[(world + 2) % 3]};
  const V sum = hn::Add(hn::Add(abs(n.x), abs(n.y)), abs(n.z));
  // The material's new surface faces the tool.
  u = hn::Div(hn::Neg(n.x), sum), v = hn::Div(hn::Neg(n.y), sum);
  const M below = hn::Gt(n.z, zero());
  const V folded_u = hn::Mul(hn::Sub(set(1), abs(v)), pick(hn::Lt(u, zero()), set(-1), set(1)));
  const V folded_v = hn::Mul(hn::Sub(set(1), abs(u)), pick(hn::Lt(v, zero()), set(-1), set(1)));
  u = pick(below, folded_u, u), v = pick(below, folded_v, v);
}

inline void normal_lanes(const SweptSurface& surface, SweptEnds& ends) {
  double radius = 0;
  for (std::size_t k = 0; k < surface.count; ++k)
    radius = std::max({radius, surface.pieces[k].r0, surface.pieces[k].r1});
  for (std::size_t k = 0; k < ends.u.size(); k += static_cast<std::size_t>(lanes())) {
    V u, v;
    map_normal(swept_normal(surface, ends, k, 1e-9 * radius), surface.world, u, v);
    hn::StoreU(u, kD, &ends.map[0][k]), hn::StoreU(v, kD, &ends.map[1][k]);
  }
}

}  // namespace riffler::sweep::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
