#include "collide/outline_lanes.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "collide/outline_lanes.cpp"
// Clang-format would sort foreach_target.h away from its place.
// clang-format off
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

#include "geom/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace riffler::HWY_NAMESPACE {

namespace {

/// Points in the half-plane, the square of the least distance from the edges so far, and whether inside.
struct Points {
  V rho, z, square;
  M inside;

  HWY_INLINE Points(V radius, V height) : rho(radius), z(height), square(set(kInfinity)), inside(no_lane()) {}

  HWY_INLINE V squared(V a, V b) const { return add(mul(a, a), mul(b, b)); }
  HWY_INLINE M level_with(const LaneEdge& e) const { return both(hn::Ge(z, set(e.from[1])), hn::Le(z, set(e.to[1]))); }

  HWY_INLINE void add_line(const LaneEdge& e) {
    const V wx = set(e.way[0]), wz = set(e.way[1]), x = sub(rho, set(e.from[0])), y = sub(z, set(e.from[1]));
    const V along = min(max(mul(add(mul(x, wx), mul(y, wz)), set(e.per_square)), zero()), set(1));
    square = min(square, squared(sub(x, mul(along, wx)), sub(y, mul(along, wz))));
    if (e.rises) inside = either(inside, both(level_with(e), hn::Le(mul(x, wz), mul(y, wx))));
  }

  HWY_INLINE void add_arc(const LaneEdge& e) {
    const V x = sub(rho, set(e.centre[0])), y = sub(z, set(e.centre[1])), r = set(e.radius);
    const V length = sqrt(squared(x, y));
    // As faces() of tool/outline.hpp.
    const M on = both(hn::Ge(mul(y, set(e.first[0])), mul(x, set(e.first[1]))),
                      hn::Ge(mul(x, set(e.last[1])), mul(y, set(e.last[0]))));
    const V off = sub(length, r);
    const V ends = min(squared(sub(rho, set(e.from[0])), sub(z, set(e.from[1]))),
                       squared(sub(rho, set(e.to[0])), sub(z, set(e.to[1]))));
    square = min(square, pick(both(on, hn::Gt(length, zero())), mul(off, off), ends));
    const M hidden =
        e.side > 0 ? either(hn::Le(x, zero()), hn::Le(length, r)) : both(hn::Le(x, zero()), hn::Ge(length, r));
    inside = either(inside, both(level_with(e), hidden));
  }

  HWY_INLINE V distance() const {
    const V d = sqrt(square);
    return pick(inside, hn::Neg(d), d);
  }
};

}  // namespace

void CentreDistances(std::span<const LaneEdge> outline, const ToolFrame& frame, const SphereGroup& spheres,
                     double* distance) {
  for (int k = 0; k < kLanes; k += lanes()) {
    const V x = sub(hn::Load(kD, spheres.x + k), set(frame.tip.x)),
            y = sub(hn::Load(kD, spheres.y + k), set(frame.tip.y));
    const V z = sub(hn::Load(kD, spheres.z + k), set(frame.tip.z));
    const auto along = [&](const Vec3& d)
                           HWY_ATTR { return add(add(mul(x, set(d.x)), mul(y, set(d.y))), mul(z, set(d.z))); };
    const V u = along(frame.u), v = along(frame.v);
    Points points(sqrt(add(mul(u, u), mul(v, v))), along(frame.axis));
    for (const LaneEdge& e : outline) e.arc ? points.add_arc(e) : points.add_line(e);
    hn::StoreU(points.distance(), kD, distance + k);
  }
}

}  // namespace riffler::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace riffler {

HWY_EXPORT(CentreDistances);

LaneEdge::LaneEdge(const OutlineEdge& e)
    : from{e.from.x, e.from.y},
      to{e.to.x, e.to.y},
      way{e.to.x - e.from.x, e.to.y - e.from.y},
      per_square(0),
      centre{},
      first{},
      last{},
      radius(std::abs(e.bulge)),
      side(e.bulge < 0 ? -1 : 1),
      arc(e.centre.has_value()),
      rises(e.to.y > e.from.y) {
  const double square = way[0] * way[0] + way[1] * way[1];
  if (square > 0) per_square = 1 / square;
  if (!arc) return;
  for (int k = 0; k < 2; ++k)
    centre[k] = (*e.centre)[k], first[k] = side * (from[k] - centre[k]), last[k] = side * (to[k] - centre[k]);
}

void centre_distances(std::span<const LaneEdge> outline, const ToolFrame& frame, const SphereGroup& spheres,
                      double* distance) {
  HWY_DYNAMIC_DISPATCH(CentreDistances)(outline, frame, spheres, distance);
}

}  // namespace riffler

#endif
