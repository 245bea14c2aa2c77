#include "collide/outline_lanes.hpp"

#include <type_traits>

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
  V distance, out, up, curvature, square, from_out, from_up;

  HWY_INLINE Plane()
      : distance(set(-kInfinity)),
        out(zero()),
        up(zero()),
        curvature(zero()),
        square(set(kInfinity)),
        from_out(zero()),
        from_up(zero()) {}

  /// `bend`: 1/mm, of the distance's level line in the half-plane.
  HWY_INLINE void add_plane(V d, V x, V y, V bend) {
    const M higher = hn::Gt(d, distance);
    distance = pick(higher, d, distance), out = pick(higher, x, out), up = pick(higher, y, up);
    curvature = pick(higher, bend, curvature);
  }
  HWY_INLINE void add_foot(V x, V y) {
    const V s = squared(x, y);
    const M nearer = hn::Lt(s, square);
    square = pick(nearer, s, square), from_out = pick(nearer, x, from_out), from_up = pick(nearer, y, from_up);
  }
  HWY_INLINE void add_line(const LaneEdge& e, const Centres& at) {
    const V x = sub(at.rho, set(e.from[0])), y = sub(at.z, set(e.from[1])), nx = set(e.normal[0]),
            ny = set(e.normal[1]);
    add_plane(add(mul(x, nx), mul(y, ny)), nx, ny, zero());
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
    add_plane(sub(add(mul(x, nx), mul(y, ny)), set(e.radius)), nx, ny, pick(on, per, zero()));
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
    distance = pick(corner, far, distance), curvature = pick(corner, per, curvature);
  }
};

HWY_INLINE V dot3(V ax, V ay, V az, V bx, V by, V bz) {
  return add(add(mul(ax, bx), mul(ay, by)), mul(az, bz));
}

/// Corners of triangles relative to points.
struct FromPoints {
  V x[3], y[3], z[3];

  HWY_INLINE FromPoints(const Corners* triangles, int k, V px, V py, V pz) {
    static_assert(sizeof(Corners) == 9 * sizeof(double));
    const hn::RebindToSigned<Lanes> kI;
    const auto places = hn::Mul(hn::Iota(kI, 0), hn::Set(kI, 9));
    const double* first = &triangles[k].a.x;
    for (int i = 0; i < 3; ++i) {
      x[i] = sub(hn::GatherIndex(kD, first + 3 * i, places), px);
      y[i] = sub(hn::GatherIndex(kD, first + 3 * i + 1, places), py);
      z[i] = sub(hn::GatherIndex(kD, first + 3 * i + 2, places), pz);
    }
  }
  HWY_INLINE FromPoints(const FromPoints& other, V px, V py, V pz) {
    for (int i = 0; i < 3; ++i) x[i] = sub(other.x[i], px), y[i] = sub(other.y[i], py), z[i] = sub(other.z[i], pz);
  }
  /// Largest distance of the corners from a place, which is relative to the points.
  HWY_INLINE V farthest(V px, V py, V pz) const {
    V far = zero();
    for (int i = 0; i < 3; ++i)
      far = max(far, add(squared(sub(x[i], px), sub(y[i], py)), mul(sub(z[i], pz), sub(z[i], pz))));
    return sqrt(far);
  }
  /// Lowest value of the corners along a direction.
  HWY_INLINE V least(V dx, V dy, V dz) const {
    V low = set(kInfinity);
    for (int i = 0; i < 3; ++i) low = min(low, dot3(dx, dy, dz, x[i], y[i], z[i]));
    return low;
  }
};

/// A linear function on triangles, by its values at the corners and its slope.
struct CornerValues {
  V at[3], x, y, z;

  HWY_INLINE CornerValues() : x(zero()), y(zero()), z(zero()) { at[0] = at[1] = at[2] = set(-kInfinity); }
};

/// Minimum over triangles of the greater of two linear functions: at a corner, or on a side where they are equal.
struct Ridge {
  V value, x, y, z;
  M on_side;  // and the functions' slopes differ clearly: two sides of the tool meet there

  HWY_INLINE Ridge(const CornerValues& f, const CornerValues& g, const FromPoints& corners)
      : value(set(kInfinity)), x(zero()), y(zero()), z(zero()), on_side(no_lane()) {
    for (int i = 0; i < 3; ++i) value = min(value, max(f.at[i], g.at[i]));
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const V here = sub(f.at[i], g.at[i]), there = sub(f.at[j], g.at[j]);
      const M crosses = hn::Lt(mul(here, there), zero());
      const V s = hn::Div(here, pick(crosses, sub(here, there), set(1)));
      const V level = min(add(f.at[i], mul(s, sub(f.at[j], f.at[i]))), add(g.at[i], mul(s, sub(g.at[j], g.at[i]))));
      const M lower = both(crosses, hn::Lt(level, value));
      value = pick(lower, level, value), on_side = either(on_side, lower);
      x = pick(lower, add(corners.x[i], mul(s, sub(corners.x[j], corners.x[i]))), x);
      y = pick(lower, add(corners.y[i], mul(s, sub(corners.y[j], corners.y[i]))), y);
      z = pick(lower, add(corners.z[i], mul(s, sub(corners.z[j], corners.z[i]))), z);
    }
    on_side = both(on_side, hn::Lt(dot3(f.x, f.y, f.z, g.x, g.y, g.z), set(0.95)));
  }
};

/// The boxes of a group, seen from their centres: bounds for FromPoints' functions.
struct FromCentres {
  const OrientedBoxes& boxes;
  V half[3], reach;

  HWY_INLINE FromCentres(const OrientedBoxes& b, int k) : boxes(b) {
    for (int i = 0; i < 3; ++i) half[i] = hn::Load(kD, b.half[i] + k);
    reach = sqrt(add(squared(half[0], half[1]), mul(half[2], half[2])));
  }
  HWY_INLINE V farthest(V px, V py, V pz) const { return add(sqrt(add(squared(px, py), mul(pz, pz))), reach); }
  HWY_INLINE V least(V dx, V dy, V dz) const {
    V low = zero();
    for (int i = 0; i < 3; ++i) low = sub(low, mul(abs(dot(dx, dy, dz, boxes.axis[i])), half[i]));
    return low;
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

/// Smallest bound, by planes or a ball, of the distance at the corners, which bounds the distance on the whole triangle
/// or box; −∞ if there is no bound. `Extent`: FromPoints or FromCentres.
template <class Extent>
class RunBound {
 public:
  /// `reach`: largest distance of a triangle's points from its point of `at`, mm.
  HWY_INLINE RunBound(const ToolFrame& frame, const Centres& at, const Extent& corners, V reach, V distance,
                      const Drifts* drifts)
      : frame_(frame), at_(at), radial_(frame, at), corners_(corners), drifts_(drifts), reach_(reach), far_(zero()) {
    nearer_ = zero();
    if (drifts) {
      far_ = add(sqrt(squared(at.rho, at.z)), reach_);
      nearer_ = drifts->nearer(far_), reach_ = add(reach_, drifts->most(far_));
    }
    outside_ = hn::Ge(distance, reach_);
    by_sphere_ = sub(sub(distance, reach), nearer_);
  }

  HWY_INLINE V by_sphere() const { return by_sphere_; }

  HWY_INLINE const Radial& radial() const { return radial_; }

  HWY_INLINE Plane plane_of(const OutlineRuns::Run& run, std::span<const LaneEdge> outline) const {
    Plane plane;
    for (std::size_t i = run.first; i < run.last; ++i)
      outline[i].arc ? plane.add_arc(outline[i], at_) : plane.add_line(outline[i], at_);
    plane.use_corner(both(behind(run.lower, at_, zero()), behind(run.upper, at_, zero())));
    return plane;
  }

  HWY_INLINE V by_plane(const OutlineRuns::Run& run, const Plane& plane) const {
    const V x = in_space(plane.out, radial_.x, plane.up, frame_.axis.x),
            y = in_space(plane.out, radial_.y, plane.up, frame_.axis.y),
            z = in_space(plane.out, radial_.z, plane.up, frame_.axis.z);
    const V bound = add(plane.distance, extent(x, y, z));
    return pick(either(holds(run), hn::Ge(bound, zero())), bound, set(-kInfinity));
  }

  /// Where the tangent planes of a run bound the distance wherever they lie.
  HWY_INLINE M holds(const OutlineRuns::Run& run) const {
    M own = both(behind(run.lower, at_, reach_), behind(run.upper, at_, reach_));
    if constexpr (std::is_same_v<Extent, FromPoints>)
      if (!drifts_) own = either(own, both(corners_behind(run.lower), corners_behind(run.upper)));
    return either(outside_, own);
  }

  /// The plane's values at the corners, −∞ where it bounds nothing.
  HWY_INLINE CornerValues at_corners(const OutlineRuns::Run& run, const Plane& plane) const {
    const V x = in_space(plane.out, radial_.x, plane.up, frame_.axis.x),
            y = in_space(plane.out, radial_.y, plane.up, frame_.axis.y),
            z = in_space(plane.out, radial_.z, plane.up, frame_.axis.z);
    const M valid = holds(run);
    CornerValues out;
    out.x = x, out.y = y, out.z = z;
    for (int i = 0; i < 3; ++i)
      out.at[i] =
          pick(valid, add(plane.distance, dot3(x, y, z, corners_.x[i], corners_.y[i], corners_.z[i])), set(-kInfinity));
    return out;
  }

  /// Bound from the ball in a hollow, which the solid never enters.
  HWY_INLINE V by_ball(const LaneEdge& hollow) const {
    const V out = sub(set(hollow.centre[0]), at_.rho), up = sub(set(hollow.centre[1]), at_.z);
    const V x = in_space(out, radial_.x, up, frame_.axis.x), y = in_space(out, radial_.y, up, frame_.axis.y),
            z = in_space(out, radial_.z, up, frame_.axis.z);
    V bound = sub(set(hollow.radius), corners_.farthest(x, y, z));
    if (drifts_) bound = sub(bound, drifts_->most(far_));
    return pick(both(outside_, radial_.off_axis), bound, set(-kInfinity));
  }

 private:
  static HWY_INLINE V in_space(V out, V radial, V up, double axis) { return add(mul(out, radial), mul(up, set(axis))); }

  /// Whether a triangle lies behind the end of a run, from its corners alone: as TriangleSearch::in_sector.
  HWY_INLINE M corners_behind(const OutlineRuns::End& end) const {
    M out = hn::Le(zero(), zero());
    if (!end.open) return out;
    const V outward = set(end.way.x), upward = set(end.way.y);
    for (int i = 0; i < 3; ++i) {
      const V x = add(at_.x, corners_.x[i]), y = add(at_.y, corners_.y[i]), z = add(at_.h, corners_.z[i]);
      const V u = dot(x, y, z, frame_.u), v = dot(x, y, z, frame_.v), h = dot(x, y, z, frame_.axis);
      const V rho = end.way.x > 0 ? sqrt(squared(u, v)) : dot3(x, y, z, radial_.x, radial_.y, radial_.z);
      const V past = add(mul(sub(rho, set(end.point.x)), outward), mul(sub(h, set(end.point.y)), upward));
      out = both(out, hn::Le(past, zero()));
    }
    return out;
  }

  HWY_INLINE V extent(V x, V y, V z) const {
    if constexpr (std::is_same_v<Extent, FromPoints>)
      if (drifts_) return least_drifting(x, y, z);
    return corners_.least(x, y, z);
  }

  /// Lowest value of the corners along a direction with drift: a corner's displacement along the direction is that of
  /// the centre plus a term from its offset.
  HWY_INLINE V least_drifting(V x, V y, V z) const
    requires std::is_same_v<Extent, FromPoints>
  {
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
  const Extent& corners_;
  const Drifts* drifts_;
  V reach_, far_;  // largest distance of the drifting sphere's points from its centre, and from the tip
  V nearer_, by_sphere_;
  M outside_;
};

/// The distance near a point to second order: linear along the plane's normal, curved around the axis and along the
/// outline.
class Quadratic {
 public:
  HWY_INLINE Quadratic(const ToolFrame& frame, const Radial& r, V rho, const Plane& p)
      : around_(hn::Div(max(p.out, zero()), max(rho, set(1e-9)))), along_(p.curvature) {
    const V ax = set(frame.axis.x), ay = set(frame.axis.y), az = set(frame.axis.z);
    normal_ = {add(mul(p.out, r.x), mul(p.up, ax)), add(mul(p.out, r.y), mul(p.up, ay)),
               add(mul(p.out, r.z), mul(p.up, az))};
    meridian_ = {sub(mul(p.out, ax), mul(p.up, r.x)), sub(mul(p.out, ay), mul(p.up, r.y)),
                 sub(mul(p.out, az), mul(p.up, r.z))};
    round_ = {sub(mul(ay, r.z), mul(az, r.y)), sub(mul(az, r.x), mul(ax, r.z)), sub(mul(ax, r.y), mul(ay, r.x))};
  }

  /// The place of its minimum on each triangle; `from`: the corners seen from the point.
  HWY_INLINE void lowest(const FromPoints& corners, const FromPoints& from, V& x, V& y, V& z) const {
    V g[3], t[3], m[3];
    for (int i = 0; i < 3; ++i) g[i] = normal_.on(from, i), t[i] = round_.on(from, i), m[i] = meridian_.on(from, i);
    V least = set(kInfinity), share = zero();
    V from_x = corners.x[0], from_y = corners.y[0], from_z = corners.z[0], way_x = zero(), way_y = zero(),
      way_z = zero();
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const V dt = sub(t[j], t[i]), dm = sub(m[j], m[i]), dg = sub(g[j], g[i]);
      const V slope = add(dg, bent(t[i], dt, m[i], dm)), bend = bent(dt, dt, dm, dm);
      const M curved = hn::Gt(bend, set(1e-300));
      const V s = pick(curved, min(max(hn::Div(hn::Neg(slope), pick(curved, bend, set(1))), zero()), set(1)),
                       pick(hn::Lt(slope, zero()), set(1), zero()));
      const V value =
          add(add(g[i], mul(set(0.5), bent(t[i], t[i], m[i], m[i]))), mul(s, add(slope, mul(set(0.5), mul(s, bend)))));
      const M lower = hn::Lt(value, least);
      least = pick(lower, value, least), share = pick(lower, s, share);
      from_x = pick(lower, corners.x[i], from_x), from_y = pick(lower, corners.y[i], from_y);
      from_z = pick(lower, corners.z[i], from_z);
      way_x = pick(lower, sub(corners.x[j], corners.x[i]), way_x);
      way_y = pick(lower, sub(corners.y[j], corners.y[i]), way_y);
      way_z = pick(lower, sub(corners.z[j], corners.z[i]), way_z);
    }
    x = add(from_x, mul(share, way_x)), y = add(from_y, mul(share, way_y)), z = add(from_z, mul(share, way_z));
    within(corners, g, t, m, x, y, z);
  }

 private:
  struct Direction {
    V x, y, z;
    HWY_INLINE V on(const FromPoints& p, int i) const {
      return add(add(mul(x, p.x[i]), mul(y, p.y[i])), mul(z, p.z[i]));
    }
  };

  /// The second-order form of two vectors, given by their components around the axis and along the outline.
  HWY_INLINE V bent(V t, V u, V m, V n) const { return add(mul(around_, mul(t, u)), mul(along_, mul(m, n))); }

  /// Where the minimum over the whole plane lies within the triangle, it is the place.
  HWY_INLINE void within(const FromPoints& corners, const V* g, const V* t, const V* m, V& x, V& y, V& z) const {
    const V t1 = sub(t[1], t[0]), t2 = sub(t[2], t[0]), m1 = sub(m[1], m[0]), m2 = sub(m[2], m[0]);
    const V a = bent(t1, t1, m1, m1), b = bent(t1, t2, m1, m2), c = bent(t2, t2, m2, m2);
    const V d1 = add(sub(g[1], g[0]), bent(t[0], t1, m[0], m1)), d2 = add(sub(g[2], g[0]), bent(t[0], t2, m[0], m2));
    const V det = sub(mul(a, c), mul(b, b));
    const M solvable = hn::Gt(det, mul(set(1e-12), mul(a, c)));
    const V per = hn::Div(set(1), pick(solvable, det, set(1)));
    const V s = mul(per, sub(mul(d2, b), mul(d1, c))), u = mul(per, sub(mul(d1, b), mul(d2, a)));
    const M on = both(both(solvable, hn::Ge(s, zero())), both(hn::Ge(u, zero()), hn::Le(add(s, u), set(1))));
    const auto place = [&](const V* p) { return add(p[0], add(mul(s, sub(p[1], p[0])), mul(u, sub(p[2], p[0])))); };
    x = pick(on, place(corners.x), x), y = pick(on, place(corners.y), y), z = pick(on, place(corners.z), z);
  }

  V around_, along_;  // curvatures, 1/mm
  Direction normal_, meridian_, round_;
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
    const FromPoints corners(triangles, k, hn::Load(kD, spheres.x + k), hn::Load(kD, spheres.y + k),
                             hn::Load(kD, spheres.z + k));
    const RunBound runs_at(frame, at, corners, hn::Load(kD, spheres.radius + k), hn::LoadU(kD, distance + k),
                           drift ? &drifts : nullptr);
    V bound = set(kInfinity);
    for (const OutlineRuns::Run& run : runs.all())
      bound = min(bound, run.reach < kInfinity ? runs_at.by_ball(outline[run.first])
                                               : runs_at.by_plane(run, runs_at.plane_of(run, outline)));
    hn::StoreU(max(bound, runs_at.by_sphere()), kD, low + k);
  }
}

void BoxBounds(const OutlineRuns& runs, std::span<const LaneEdge> outline, const ToolFrame& frame,
               const OrientedBoxes& boxes, double* low, double* high) {
  for (int k = 0; k < base::kLanes; k += lanes()) {
    const Centres at(frame, sub(hn::Load(kD, boxes.x + k), set(frame.tip.x)),
                     sub(hn::Load(kD, boxes.y + k), set(frame.tip.y)),
                     sub(hn::Load(kD, boxes.z + k), set(frame.tip.z)));
    Points points(at.rho, at.z);
    for (const LaneEdge& e : outline) e.arc ? points.add_arc(e) : points.add_line(e);
    const V distance = points.distance();
    const FromCentres extent(boxes, k);
    const RunBound runs_at(frame, at, extent, extent.reach, distance, nullptr);
    V bound = set(kInfinity);
    for (const OutlineRuns::Run& run : runs.all())
      bound = min(bound, run.reach < kInfinity ? runs_at.by_ball(outline[run.first])
                                               : runs_at.by_plane(run, runs_at.plane_of(run, outline)));
    hn::StoreU(max(bound, runs_at.by_sphere()), kD, low + k);
    hn::StoreU(add(distance, extent.reach), kD, high + k);
  }
}

void LowestPlaces(const OutlineRuns& runs, std::span<const LaneEdge> outline, const ToolFrame& frame,
                  const Corners* triangles, double enough, double slack, LanePlaces& places) {
  constexpr int kSteps = 6;
  constexpr std::size_t kKept = 4;  // runs whose planes of the step before are kept
  for (int k = 0; k < base::kLanes; k += lanes()) {
    const FromPoints corners(triangles, k, set(frame.tip.x), set(frame.tip.y), set(frame.tip.z));
    const V third = set(1.0 / 3);
    V x = mul(third, add(add(corners.x[0], corners.x[1]), corners.x[2])),
      y = mul(third, add(add(corners.y[0], corners.y[1]), corners.y[2])),
      z = mul(third, add(add(corners.z[0], corners.z[1]), corners.z[2]));
    V best = set(kInfinity), best_x = x, best_y = y, best_z = z, low = hn::LoadU(kD, places.low + k);
    CornerValues kept[kKept];
    M active = hn::Le(zero(), zero());  // a lane's result must not depend on how many others there are
    for (int step = 0;; ++step) {
      const Centres at(frame, x, y, z);
      Points points(at.rho, at.z);
      for (const LaneEdge& e : outline) e.arc ? points.add_arc(e) : points.add_line(e);
      const V distance = points.distance();
      const M lower = both(active, hn::Lt(distance, best));
      best = pick(lower, distance, best);
      best_x = pick(lower, x, best_x), best_y = pick(lower, y, best_y), best_z = pick(lower, z, best_z);
      const FromPoints from(corners, x, y, z);
      const RunBound runs_at(frame, at, from, from.farthest(zero(), zero(), zero()), distance, nullptr);
      Plane steepest;
      steepest.distance = set(kInfinity);
      V bound = set(kInfinity), ridge_x = x, ridge_y = y, ridge_z = z;
      M on_ridge = no_lane();
      for (std::size_t j = 0; j < runs.size(); ++j) {
        const OutlineRuns::Run& run = runs.all()[j];
        if (run.reach < kInfinity) {
          bound = min(bound, runs_at.by_ball(outline[run.first]));
          continue;
        }
        const Plane plane = runs_at.plane_of(run, outline);
        V by_run = runs_at.by_plane(run, plane);
        if (j < kKept) {
          const CornerValues values = runs_at.at_corners(run, plane);
          if (step > 0) {
            const Ridge ridge(kept[j], values, corners);
            const M higher = hn::Gt(ridge.value, by_run);
            by_run = pick(higher, ridge.value, by_run);
            const M there = both(higher, ridge.on_side);
            on_ridge = either(on_ridge, there);
            ridge_x = pick(there, ridge.x, ridge_x), ridge_y = pick(there, ridge.y, ridge_y);
            ridge_z = pick(there, ridge.z, ridge_z);
          }
          kept[j] = values;
        }
        bound = min(bound, by_run);
        const M nearest = hn::Lt(plane.distance, steepest.distance);
        steepest.distance = pick(nearest, plane.distance, steepest.distance);
        steepest.out = pick(nearest, plane.out, steepest.out), steepest.up = pick(nearest, plane.up, steepest.up);
        steepest.curvature = pick(nearest, plane.curvature, steepest.curvature);
      }
      low = pick(active, max(low, max(bound, runs_at.by_sphere())), low);
      active = both(active, both(hn::Lt(low, set(enough)), hn::Lt(low, sub(best, set(slack)))));
      if (none(active) || step + 1 == kSteps) break;
      Quadratic(frame, runs_at.radial(), at.rho, steepest).lowest(corners, from, x, y, z);
      x = pick(on_ridge, ridge_x, x), y = pick(on_ridge, ridge_y, y), z = pick(on_ridge, ridge_z, z);
    }
    hn::StoreU(low, kD, places.low + k), hn::StoreU(best, kD, places.distance + k);
    hn::StoreU(best_x, kD, places.x + k), hn::StoreU(best_y, kD, places.y + k), hn::StoreU(best_z, kD, places.z + k);
  }
}

}  // namespace riffler::collide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace riffler::collide {

HWY_EXPORT(CentreDistances);
HWY_EXPORT(TriangleBounds);
HWY_EXPORT(LowestPlaces);
HWY_EXPORT(BoxBounds);

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

void box_bounds(const OutlineRuns& runs, std::span<const LaneEdge> outline, const ToolFrame& frame,
                const OrientedBoxes& boxes, double* low, double* high) {
  HWY_DYNAMIC_DISPATCH(BoxBounds)(runs, outline, frame, boxes, low, high);
}

void lowest_places(const OutlineRuns& runs, std::span<const LaneEdge> outline, const ToolFrame& frame,
                   const Corners* triangles, double enough, double slack, LanePlaces& places) {
  HWY_DYNAMIC_DISPATCH(LowestPlaces)(runs, outline, frame, triangles, enough, slack, places);
}

}  // namespace riffler::collide

#endif
