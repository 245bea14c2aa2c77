// Points in a tool's half-plane, in vector lanes: the common part of the kernels over a tool's outline. Included once
// per instruction set, as base/lanes-inl.hpp.
#if defined(RIFFLER_COLLIDE_OUTLINE_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RIFFLER_COLLIDE_OUTLINE_INL_HPP
#undef RIFFLER_COLLIDE_OUTLINE_INL_HPP
#else
#define RIFFLER_COLLIDE_OUTLINE_INL_HPP
#endif

#include "base/lanes-inl.hpp"
#include "collide/outline_lanes.hpp"
#include "geom/math.hpp"

HWY_BEFORE_NAMESPACE();
namespace riffler::collide::HWY_NAMESPACE {

using namespace base::HWY_NAMESPACE;

namespace {

HWY_INLINE V squared(V a, V b) {
  return add(mul(a, a), mul(b, b));
}

HWY_INLINE V dot(V x, V y, V z, const Vec3& d) {
  return add(add(mul(x, set(d.x)), mul(y, set(d.y))), mul(z, set(d.z)));
}

/// Whether a point, relative to an arc's centre, lies in the arc's sector: as faces() of tool/outline.hpp.
HWY_INLINE M in_sector(const LaneEdge& e, V x, V y) {
  return both(hn::Ge(mul(y, set(e.first[0])), mul(x, set(e.first[1]))),
              hn::Ge(mul(x, set(e.last[1])), mul(y, set(e.last[0]))));
}

/// Points, such as the centres of spheres, in the tool's half-plane.
struct Centres {
  V x, y, h;  // relative to the tip, in part directions
  V u, v, rho, z;

  HWY_INLINE Centres(const ToolFrame& frame, const SphereGroup& spheres, int k)
      : Centres(frame, sub(hn::Load(kD, spheres.x + k), set(frame.tip.x)),
                sub(hn::Load(kD, spheres.y + k), set(frame.tip.y)),
                sub(hn::Load(kD, spheres.z + k), set(frame.tip.z))) {}
  HWY_INLINE Centres(const ToolFrame& frame, V px, V py, V pz) : x(px), y(py), h(pz) {
    u = dot(x, y, h, frame.u), v = dot(x, y, h, frame.v), z = dot(x, y, h, frame.axis);
    rho = sqrt(squared(u, v));
  }
};

/// Points in the half-plane with the smallest squared distance to the edges so far, and whether they are inside.
struct Points {
  V rho, z, square;
  M inside;

  HWY_INLINE Points(V radius, V height) : rho(radius), z(height), square(set(kInfinity)), inside(no_lane()) {}

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
    const M on = in_sector(e, x, y);
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

}  // namespace riffler::collide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
