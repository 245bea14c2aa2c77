#include "collide/outline_lanes.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "collide/outline_lanes.cpp"
// foreach_target.h must stay here; clang-format would sort it.
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

#include "collide/outline-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace riffler::collide::HWY_NAMESPACE {

using namespace base::HWY_NAMESPACE;

namespace {

/// Among the tangent planes of a run's edges, the one with the largest signed distance at a point, with its normal.
/// Also the vector from the nearest point of the run, which may be a corner.
struct Plane {
  V distance, out, up, square, from_out, from_up;

  HWY_INLINE Plane()
      : distance(set(-kInfinity)), out(zero()), up(zero()), square(set(kInfinity)), from_out(zero()), from_up(zero()) {}

  HWY_INLINE void add_plane(V d, V x, V y) {
    const M higher = hn::Gt(d, distance);
    distance = pick(higher, d, distance), out = pick(higher, x, out), up = pick(higher, y, up);
  }
  HWY_INLINE void add_foot(V x, V y) {
    const V s = squared(x, y);
    const M nearer = hn::Lt(s, square);
    square = pick(nearer, s, square), from_out = pick(nearer, x, from_out), from_up = pick(nearer, y, from_up);
  }
  HWY_INLINE void add_line(const LaneEdge& e, const Centres& at) {
    const V x = sub(at.rho, set(e.from[0])), y = sub(at.z, set(e.from[1])), nx = set(e.normal[0]),
            ny = set(e.normal[1]);
    add_plane(add(mul(x, nx), mul(y, ny)), nx, ny);
    const V wx = set(e.way[0]), wy = set(e.way[1]);
    const V along = min(max(mul(add(mul(x, wx), mul(y, wy)), set(e.per_square)), zero()), set(1));
    add_foot(sub(x, mul(along, wx)), sub(y, mul(along, wy)));
  }
  HWY_INLINE void add_arc(const LaneEdge& e, const Centres& at) {
    const V x = sub(at.rho, set(e.centre[0])), y = sub(at.z, set(e.centre[1])), length = sqrt(squared(x, y));
    const M on = both(in_sector(e, x, y), hn::Gt(length, zero()));
    const M first = hn::Le(squared(sub(x, set(e.first[0])), sub(y, set(e.first[1]))),
                           squared(sub(x, set(e.last[0])), sub(y, set(e.last[1]))));
    const V ex = pick(first, set(e.first[0]), set(e.last[0])), ey = pick(first, set(e.first[1]), set(e.last[1]));
    const V per = hn::Div(set(1), pick(on, length, set(e.radius)));
    const V nx = mul(per, pick(on, x, ex)), ny = mul(per, pick(on, y, ey));
    add_plane(sub(add(mul(x, nx), mul(y, ny)), set(e.radius)), nx, ny);
    const V off = sub(length, set(e.radius));
    add_foot(pick(on, mul(off, nx), sub(x, ex)), pick(on, mul(off, ny), sub(y, ey)));
  }
  /// From outside, a corner may be farther than every plane; then the plane that touches the corner perpendicular to
  /// the connecting line is the steeper bound. Used only where clearly farther, since its direction would otherwise be
  /// rounding noise.
  HWY_INLINE void use_corner(M may) {
    const V far = sqrt(square);
    const M farther = both(hn::Gt(far, set(1e-6)), hn::Gt(far, mul(distance, set(1 + 1e-6))));
    const M corner = both(may, both(hn::Gt(distance, zero()), farther));
    const V per = hn::Div(set(1), far);
    out = pick(corner, mul(from_out, per), out), up = pick(corner, mul(from_up, per), up);
    distance = pick(corner, far, distance);
  }
};

/// Corners of triangles relative to the centres of their spheres.
struct FromCentres {
  V x[3], y[3], z[3];

  HWY_INLINE FromCentres(const Corners* triangles, const SphereGroup& spheres, int k) {
    static_assert(sizeof(Corners) == 9 * sizeof(double));
    const hn::RebindToSigned<Lanes> kI;
    const auto places = hn::Mul(hn::Iota(kI, 0), hn::Set(kI, 9));
    const double* first = &triangles[k].a.x;
    const V cx = hn::Load(kD, spheres.x + k), cy = hn::Load(kD, spheres.y + k), cz = hn::Load(kD, spheres.z + k);
    for (int i = 0; i < 3; ++i) {
      x[i] = sub(hn::GatherIndex(kD, first + 3 * i, places), cx);
      y[i] = sub(hn::GatherIndex(kD, first + 3 * i + 1, places), cy);
      z[i] = sub(hn::GatherIndex(kD, first + 3 * i + 2, places), cz);
    }
  }
};

/// Whether everything within `radius` of a point lies behind the end of a run.
HWY_INLINE M behind(const OutlineRuns::End& end, const Centres& at, V radius) {
  const V past =
      add(mul(sub(at.rho, set(end.point.x)), set(end.way.x)), mul(sub(at.z, set(end.point.y)), set(end.way.y)));
  return end.open ? hn::Le(add(past, radius), zero()) : hn::Le(radius, set(kInfinity));
}

/// The radial direction in space, 0 on the axis.
struct Radial {
  V x, y, z;
  M off_axis;

  HWY_INLINE Radial(const ToolFrame& frame, const Centres& at) : off_axis(hn::Gt(at.rho, set(1e-150))) {
    const V per = hn::Div(set(1), pick(off_axis, at.rho, set(1)));
    const V u = pick(off_axis, mul(at.u, per), zero()), v = pick(off_axis, mul(at.v, per), zero());
    x = add(mul(u, set(frame.u.x)), mul(v, set(frame.v.x)));
    y = add(mul(u, set(frame.u.y)), mul(v, set(frame.v.y)));
    z = add(mul(u, set(frame.u.z)), mul(v, set(frame.v.z)));
  }
};

/// The data of a drift that are the same for all lanes.
struct Drifts {
  Drift drift;
  double way, turn;

  explicit Drifts(const Drift& d) : drift(d), way(glm::length(d.way)), turn(glm::length(d.turn)) {}

  HWY_INLINE V most(V distance) const { return add(set(way), mul(set(turn), add(distance, set(way)))); }
  HWY_INLINE V nearer(V distance) const {
    return add(set(way), mul(set(turn), min(add(distance, set(way)), set(drift.reach))));
  }
  HWY_INLINE V second_order(V distance) const {
    return mul(set(0.5 * turn), add(mul(set(turn), add(distance, set(way))), set(2 * way)));
  }
};

/// Smallest bound, by planes or a ball, of the distance at the corners, which bounds the distance on the whole
/// triangle; −∞ if there is no bound.
class RunBound {
 public:
  HWY_INLINE RunBound(const ToolFrame& frame, const Centres& at, const Corners* triangles, const SphereGroup& spheres,
                      int k, V distance, const Drifts* drifts)
      : frame_(frame),
        at_(at),
        radial_(frame, at),
        corners_(triangles, spheres, k),
        drifts_(drifts),
        reach_(hn::Load(kD, spheres.radius + k)),
        far_(zero()) {
    nearer_ = zero();
    if (drifts) {
      far_ = add(sqrt(squared(at.rho, at.z)), reach_);
      nearer_ = drifts->nearer(far_), reach_ = add(reach_, drifts->most(far_));
    }
    outside_ = hn::Ge(distance, reach_);
    by_sphere_ = sub(sub(distance, hn::Load(kD, spheres.radius + k)), nearer_);
  }

  HWY_INLINE V by_sphere() const { return by_sphere_; }

  HWY_INLINE V by_plane(const OutlineRuns::Run& run, std::span<const LaneEdge> outline) const {
    Plane plane;
    for (std::size_t i = run.first; i < run.last; ++i)
      outline[i].arc ? plane.add_arc(outline[i], at_) : plane.add_line(outline[i], at_);
    plane.use_corner(both(behind(run.lower, at_, zero()), behind(run.upper, at_, zero())));
    const V x = in_space(plane.out, radial_.x, plane.up, frame_.axis.x),
            y = in_space(plane.out, radial_.y, plane.up, frame_.axis.y),
            z = in_space(plane.out, radial_.z, plane.up, frame_.axis.z);
    const V bound = add(plane.distance, drifts_ ? least_drifting(x, y, z) : least(x, y, z));
    const M own = both(behind(run.lower, at_, reach_), behind(run.upper, at_, reach_));
    return pick(either(either(outside_, own), hn::Ge(bound, zero())), bound, set(-kInfinity));
  }

  /// Bound from the ball in a hollow, which the solid never enters.
  HWY_INLINE V by_ball(const LaneEdge& hollow) const {
    const V out = sub(set(hollow.centre[0]), at_.rho), up = sub(set(hollow.centre[1]), at_.z);
    const V x = in_space(out, radial_.x, up, frame_.axis.x), y = in_space(out, radial_.y, up, frame_.axis.y),
            z = in_space(out, radial_.z, up, frame_.axis.z);
    V far = zero();
    for (int i = 0; i < 3; ++i)
      far = max(far, add(squared(sub(corners_.x[i], x), sub(corners_.y[i], y)),
                         mul(sub(corners_.z[i], z), sub(corners_.z[i], z))));
    V bound = sub(set(hollow.radius), sqrt(far));
    if (drifts_) bound = sub(bound, drifts_->most(far_));
    return pick(both(outside_, radial_.off_axis), bound, set(-kInfinity));
  }

 private:
  static HWY_INLINE V in_space(V out, V radial, V up, double axis) { return add(mul(out, radial), mul(up, set(axis))); }
  static HWY_INLINE V dot3(V ax, V ay, V az, V bx, V by, V bz) {
    return add(add(mul(ax, bx), mul(ay, by)), mul(az, bz));
  }

  /// Lowest value of the corners along a direction.
  HWY_INLINE V least(V x, V y, V z) const {
    V low = set(kInfinity);
    for (int i = 0; i < 3; ++i) low = min(low, dot3(x, y, z, corners_.x[i], corners_.y[i], corners_.z[i]));
    return low;
  }
  /// The same with drift: a corner's displacement along the direction is that of the centre plus a term from its
  /// offset.
  HWY_INLINE V least_drifting(V x, V y, V z) const {
    const Drift& d = drifts_->drift;
    // (turn × q) · g = (g × turn) · q
    const V hx = sub(mul(y, set(d.turn.z)), mul(z, set(d.turn.y))),
            hy = sub(mul(z, set(d.turn.x)), mul(x, set(d.turn.z))),
            hz = sub(mul(x, set(d.turn.y)), mul(y, set(d.turn.x)));
    const V centre = add(dot(x, y, z, d.way), dot3(hx, hy, hz, at_.x, at_.y, at_.h));
    V low = set(kInfinity);
    for (int i = 0; i < 3; ++i) {
      const V down = dot3(x, y, z, corners_.x[i], corners_.y[i], corners_.z[i]);
      const V along = add(centre, dot3(hx, hy, hz, corners_.x[i], corners_.y[i], corners_.z[i]));
      low = min(low, sub(down, abs(along)));
    }
    return sub(low, drifts_->second_order(far_));
  }

  const ToolFrame& frame_;
  const Centres& at_;
  Radial radial_;
  FromCentres corners_;
  const Drifts* drifts_;
  V reach_, far_;  // largest distance of the drifting sphere's points from its centre, and from the tip
  V nearer_, by_sphere_;
  M outside_;
};

}  // namespace

void CentreDistances(std::span<const LaneEdge> outline, const ToolFrame& frame, const SphereGroup& spheres,
                     double* distance) {
  for (int k = 0; k < base::kLanes; k += lanes()) {
    const Centres at(frame, spheres, k);
    Points points(at.rho, at.z);
    for (const LaneEdge& e : outline) e.arc ? points.add_arc(e) : points.add_line(e);
    hn::StoreU(points.distance(), kD, distance + k);
  }
}

void TriangleBounds(const OutlineRuns& runs, std::span<const LaneEdge> outline, const ToolFrame& frame,
                    const SphereGroup& spheres, const Corners* triangles, const Drift* drift, const double* distance,
                    double* low) {
  const Drifts drifts(drift ? *drift : Drift());
  for (int k = 0; k < base::kLanes; k += lanes()) {
    const Centres at(frame, spheres, k);
    const RunBound runs_at(frame, at, triangles, spheres, k, hn::LoadU(kD, distance + k), drift ? &drifts : nullptr);
    V bound = set(kInfinity);
    for (const OutlineRuns::Run& run : runs.all())
      bound = min(bound, run.reach < kInfinity ? runs_at.by_ball(outline[run.first]) : runs_at.by_plane(run, outline));
    hn::StoreU(max(bound, runs_at.by_sphere()), kD, low + k);
  }
}

}  // namespace riffler::collide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace riffler::collide {

HWY_EXPORT(CentreDistances);
HWY_EXPORT(TriangleBounds);

LaneEdge::LaneEdge(const tool::OutlineEdge& e)
    : from{e.from.x, e.from.y},
      to{e.to.x, e.to.y},
      way{e.to.x - e.from.x, e.to.y - e.from.y},
      per_square(0),
      normal{},
      centre{},
      first{},
      last{},
      radius(std::abs(e.bulge)),
      side(e.bulge < 0 ? -1 : 1),
      arc(e.centre.has_value()),
      rises(e.to.y > e.from.y) {
  const double square = way[0] * way[0] + way[1] * way[1];
  if (square > 0)
    per_square = 1 / square, normal[0] = way[1] / std::sqrt(square), normal[1] = -way[0] / std::sqrt(square);
  if (!arc) return;
  for (int k = 0; k < 2; ++k)
    centre[k] = (*e.centre)[k], first[k] = side * (from[k] - centre[k]), last[k] = side * (to[k] - centre[k]);
}

void centre_distances(std::span<const LaneEdge> outline, const ToolFrame& frame, const SphereGroup& spheres,
                      double* distance) {
  HWY_DYNAMIC_DISPATCH(CentreDistances)(outline, frame, spheres, distance);
}

void triangle_bounds(const OutlineRuns& runs, std::span<const LaneEdge> outline, const ToolFrame& frame,
                     const SphereGroup& spheres, const Corners* triangles, const Drift* drift, const double* distance,
                     double* low) {
  HWY_DYNAMIC_DISPATCH(TriangleBounds)(runs, outline, frame, spheres, triangles, drift, distance, low);
}

}  // namespace riffler::collide

#endif
