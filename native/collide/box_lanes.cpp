#include "collide/box_lanes.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "collide/box_lanes.cpp"
// foreach_target.h must stay here; clang-format would sort it.
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

#include "collide/outline-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace riffler::collide::HWY_NAMESPACE {

using namespace base::HWY_NAMESPACE;

namespace {

/// As Points, with the direction away from the outline.
struct Slopes {
  Points points;
  V out, up;            // away from the nearest point so far
  V edge_out, edge_up;  // the edge's normal there: the direction if the point is too near to have its own

  HWY_INLINE Slopes(const Centres& at)
      : points(at.rho, at.z), out(zero()), up(zero()), edge_out(zero()), edge_up(zero()) {}

  HWY_INLINE void look(const LaneEdge& e) {
    const V before = points.square;
    if (e.arc)
      add_arc(e, before);
    else
      add_line(e, before);
  }

  HWY_INLINE void take(M nearer, V x, V y, V normal_out, V normal_up) {
    out = pick(nearer, x, out), up = pick(nearer, y, up);
    edge_out = pick(nearer, normal_out, edge_out), edge_up = pick(nearer, normal_up, edge_up);
  }
  HWY_INLINE void add_line(const LaneEdge& e, V before) {
    points.add_line(e);
    const V wx = set(e.way[0]), wy = set(e.way[1]), x = sub(points.rho, set(e.from[0])),
            y = sub(points.z, set(e.from[1]));
    const V along = min(max(mul(add(mul(x, wx), mul(y, wy)), set(e.per_square)), zero()), set(1));
    take(hn::Lt(points.square, before), sub(x, mul(along, wx)), sub(y, mul(along, wy)), set(e.normal[0]),
         set(e.normal[1]));
  }
  HWY_INLINE void add_arc(const LaneEdge& e, V before) {
    points.add_arc(e);
    const V x = sub(points.rho, set(e.centre[0])), y = sub(points.z, set(e.centre[1])), length = sqrt(squared(x, y));
    const M on = both(in_sector(e, x, y), hn::Gt(length, zero()));
    const V fx = sub(points.rho, set(e.from[0])), fy = sub(points.z, set(e.from[1])),
            tx = sub(points.rho, set(e.to[0])), ty = sub(points.z, set(e.to[1]));
    const M first = hn::Le(squared(fx, fy), squared(tx, ty));
    const V per = hn::Div(set(1), pick(on, length, set(e.radius))), off = sub(set(1), mul(set(e.radius), per)),
            outward = mul(set(e.side), per);
    take(hn::Lt(points.square, before), pick(on, mul(off, x), pick(first, fx, tx)),
         pick(on, mul(off, y), pick(first, fy, ty)),
         pick(on, mul(outward, x), mul(per, pick(first, set(e.first[0]), set(e.last[0])))),
         pick(on, mul(outward, y), mul(per, pick(first, set(e.first[1]), set(e.last[1])))));
  }

  /// Normal of the tool's surface, out of the solid.
  HWY_INLINE void normal(V distance, V& x, V& y) const {
    const V size = abs(distance);
    const M far = hn::Gt(size, set(1e-9));
    const V per = hn::Div(set(1), pick(far, distance, set(1)));
    x = pick(far, mul(per, out), edge_out), y = pick(far, mul(per, up), edge_up);
  }
};

/// Adds the fraction of a rectangle's area that lies behind a line at signed distance t from its centre, and the
/// derivative of that fraction by t. p ≥ q: half sides of the rectangle projected on the line's normal.
HWY_INLINE void add_rectangle(V t, V p, V q, V per_p, V& share, V& rise) {
  const V size = abs(t);
  // If the line crosses two opposite sides, the area behind it is a trapezium; otherwise a triangle at a corner is
  // missing, or is all there is.
  const V corner = max(sub(add(p, q), size), zero());
  const M slanted = hn::Gt(size, sub(p, q));
  const V part = mul(corner, hn::Div(per_p, mul(set(4), max(q, set(1e-150)))));  // corner / 4 p q
  const V half = pick(slanted, sub(set(0.5), mul(mul(set(0.5), corner), part)), mul(set(0.5), mul(size, per_p)));
  share = add(share, add(set(0.5), with_sign(max(half, zero()), t)));
  rise = add(rise, pick(slanted, part, mul(set(0.5), per_p)));
}

}  // namespace

void Shares(std::span<const LaneEdge> outline, const ToolFrame& frame, const SphereGroup& spheres,
            const BoxGroup& boxes, BoxShares& out) {
  const V root = set(0.57735026918962576);  // √⅓: the nodes of Gauss's rule
  for (int k = 0; k < base::kLanes; k += lanes()) {
    const Centres at(frame, spheres, k);
    Slopes slopes(at);
    for (const LaneEdge& e : outline) slopes.look(e);
    const V distance = slopes.points.distance();
    V radial, up;
    slopes.normal(distance, radial, up);
    const M off_axis = hn::Gt(at.rho, set(1e-150));
    const V per = mul(radial, hn::Div(set(1), pick(off_axis, at.rho, set(1))));
    // On the axis any direction is valid.
    const V u = pick(off_axis, mul(per, at.u), radial), v = pick(off_axis, mul(per, at.v), zero());
    const auto along = [&](double fu, double fv, double fa) {
      return add(add(mul(u, set(fu)), mul(v, set(fv))), mul(up, set(fa)));
    };
    const V nx = along(frame.u.x, frame.v.x, frame.axis.x), ny = along(frame.u.y, frame.v.y, frame.axis.y),
            nz = along(frame.u.z, frame.v.z, frame.axis.z);
    const V a = mul(abs(nx), hn::Load(kD, boxes.half[0] + k)), b = mul(abs(ny), hn::Load(kD, boxes.half[1] + k)),
            c = mul(abs(nz), hn::Load(kD, boxes.half[2] + k));
    const V p = max(max(max(a, b), c), set(1e-12)), s = mul(root, min(min(a, b), c)),
            q = max(min(a, b), min(max(a, b), c));
    const V per_p = hn::Div(set(1), p), t = hn::Neg(distance);
    V share = zero(), rise = zero();
    add_rectangle(add(t, s), p, q, per_p, share, rise), add_rectangle(sub(t, s), p, q, per_p, share, rise);
    hn::StoreU(distance, kD, out.distance + k);
    hn::StoreU(mul(set(0.5), share), kD, out.share + k), hn::StoreU(mul(set(0.5), rise), kD, out.rise + k);
    hn::StoreU(nx, kD, out.normal[0] + k), hn::StoreU(ny, kD, out.normal[1] + k);
    hn::StoreU(nz, kD, out.normal[2] + k);
  }
}

}  // namespace riffler::collide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace riffler::collide {

HWY_EXPORT(Shares);

void box_shares(std::span<const LaneEdge> outline, const ToolFrame& frame, const SphereGroup& spheres,
                const BoxGroup& boxes, BoxShares& out) {
  HWY_DYNAMIC_DISPATCH(Shares)(outline, frame, spheres, boxes, out);
}

}  // namespace riffler::collide

#endif
