// Bounds of a tool's distance over triangles and boxes from tangent planes of its outline, in vector lanes: the common
// part of outline_lanes.cpp and lowest_places.cpp. Included once per instruction set, as base/lanes-inl.hpp.
#if defined(RIFFLER_COLLIDE_OUTLINE_BOUNDS_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RIFFLER_COLLIDE_OUTLINE_BOUNDS_INL_HPP
#undef RIFFLER_COLLIDE_OUTLINE_BOUNDS_INL_HPP
#else
#define RIFFLER_COLLIDE_OUTLINE_BOUNDS_INL_HPP
#endif

#include <type_traits>

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

/// The boxes of a group, seen from points of theirs: bounds for FromPoints' functions. The points are the centres, but
/// along sides that are long for the tool they are opposite the tool's axis, since a plane that touches the tool far
/// from where the box is nearest bounds nothing.
struct FromBoxes {
  const OrientedBoxes& boxes;
  V half[3], off[3], reach;  // off: of the points from the centres, along the axes
  V x, y, z;                 // the points, relative to the tip

  HWY_INLINE FromBoxes(const OrientedBoxes& b, int k, const ToolFrame& frame, std::span<const LaneEdge> outline)
      : boxes(b) {
    const LaneEdge& end = outline.front();
    const double lowest = end.arc ? end.centre[1] : end.from[1], highest = std::max(lowest, outline.back().to[1]);
    double width = kInfinity;  // radius of the tool's thinnest part
    for (const LaneEdge& e : outline)
      if (e.to[0] > 0) width = std::min(width, e.to[0]);
    const V cx = sub(hn::Load(kD, b.x + k), set(frame.tip.x)), cy = sub(hn::Load(kD, b.y + k), set(frame.tip.y)),
            cz = sub(hn::Load(kD, b.z + k), set(frame.tip.z));
    x = cx, y = cy, z = cz;
    for (int i = 0; i < 3; ++i) half[i] = hn::Load(kD, b.half[i] + k), off[i] = zero();
    for (int turn = 0; turn < 2; ++turn) {
      const V along = min(max(dot(x, y, z, frame.axis), set(lowest)), set(highest));
      const V wx = sub(mul(along, set(frame.axis.x)), cx), wy = sub(mul(along, set(frame.axis.y)), cy),
              wz = sub(mul(along, set(frame.axis.z)), cz);
      x = cx, y = cy, z = cz;
      for (int i = 0; i < 3; ++i) {
        const Vec3& a = b.axis[i];
        const V there = min(max(dot(wx, wy, wz, a), hn::Neg(half[i])), half[i]);
        off[i] = pick(hn::Gt(half[i], set(kLong * width)), there, zero());
        x = add(x, mul(off[i], set(a.x))), y = add(y, mul(off[i], set(a.y))), z = add(z, mul(off[i], set(a.z)));
      }
    }
    const V across = add(half[0], abs(off[0])), up = add(half[1], abs(off[1])), deep = add(half[2], abs(off[2]));
    reach = mul(sqrt(add(squared(across, up), mul(deep, deep))), set(1 + 1e-14));
  }
  HWY_INLINE V farthest(V px, V py, V pz) const { return add(sqrt(add(squared(px, py), mul(pz, pz))), reach); }
  HWY_INLINE V least(V dx, V dy, V dz) const {
    V low = zero();
    for (int i = 0; i < 3; ++i) {
      const V slope = dot(dx, dy, dz, boxes.axis[i]);
      low = sub(low, add(mul(abs(slope), half[i]), mul(slope, off[i])));
    }
    return low;
  }
  /// Largest size of the component of offsets from the point along a direction.
  HWY_INLINE V widest(V dx, V dy, V dz) const {
    V wide = zero();
    for (int i = 0; i < 3; ++i) wide = add(wide, mul(abs(dot(dx, dy, dz, boxes.axis[i])), add(half[i], abs(off[i]))));
    return wide;
  }

 private:
  static constexpr double kLong = 0.5;  // times the tool's radius
};

/// How far a point lies beyond the end of a run.
HWY_INLINE V past(const OutlineRuns::End& end, const Centres& at) {
  return add(mul(sub(at.rho, set(end.point.x)), set(end.way.x)), mul(sub(at.z, set(end.point.y)), set(end.way.y)));
}

/// Combines the bounds of a tool's runs. A run's plane bounds how far its convex solid C is. Below the plane it bounds
/// the depth in C, which is the depth in the tool if all feet lie on the run ("holds"), or if every other run's solid
/// is at least as far as the plane is deep: then the way out of C leaves the tool.
class LeastOfRuns {
 public:
  HWY_INLINE LeastOfRuns() : held_(set(kInfinity)), least_(set(kInfinity)), second_(set(kInfinity)) {}

  /// `beyond`: a bound for the points of which the run's does not hold.
  HWY_INLINE void add_run(V bound, M holds, V beyond) {
    held_ = min(held_, pick(either(holds, hn::Ge(bound, zero())), bound, min(bound, beyond)));
    second_ = min(second_, max(least_, bound)), least_ = min(least_, bound);
  }
  /// `bound`: of a run whose bound always holds, −∞ if there is none.
  HWY_INLINE void add_run(V bound) {
    held_ = min(held_, bound);
    second_ = min(second_, max(least_, bound)), least_ = min(least_, bound);
  }
  HWY_INLINE V bound() const { return max(held_, pick(hn::Ge(second_, hn::Neg(least_)), least_, set(-kInfinity))); }

 private:
  V held_, least_, second_;
};

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
/// or box; −∞ if there is no bound. `Extent`: FromPoints or FromBoxes.
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
    const auto before = [&](const OutlineRuns::End& end) {
      return end.open ? hn::Le(past(end, at_), zero()) : hn::Le(zero(), zero());
    };
    plane.use_corner(both(before(run.lower), before(run.upper)));
    // Below or above the whole solid its disc is a plane, too. The tangents at the ends of a shank that is thinner than
    // the cutter lead through the cutter, so they say nothing about points at its tip. A little less than the distance,
    // because another run that ends at this disc, at the same depth below it, continues behind it (LeastOfRuns).
    const auto add_disc = [&](V beyond, double up) {
      plane.add_plane(pick(hn::Ge(beyond, reach_), sub(beyond, set(kBeforeDisc)), set(-kInfinity)), zero(), set(up),
                      zero());
    };
    add_disc(sub(set(run.lower.point.y), at_.z), -1), add_disc(sub(at_.z, set(run.upper.point.y)), 1);
    return plane;
  }

  /// Bounds nothing but how far a run's convex solid is, or how deep below the plane: see LeastOfRuns.
  HWY_INLINE V by_plane(const Plane& plane) const {
    const V x = in_space(plane.out, radial_.x, plane.up, frame_.axis.x),
            y = in_space(plane.out, radial_.y, plane.up, frame_.axis.y),
            z = in_space(plane.out, radial_.z, plane.up, frame_.axis.z);
    return add(plane.distance, extent(x, y, z));
  }

  /// Where the tangent planes of a run bound the distance wherever they lie.
  HWY_INLINE M holds(const OutlineRuns::Run& run) const {
    const auto behind = [&](const OutlineRuns::End& end) {
      return end.narrow ? hn::Le(add(past(end, at_), reach_), zero()) : hn::Le(zero(), zero());
    };
    M own = both(behind(run.lower), behind(run.upper));
    if constexpr (std::is_same_v<Extent, FromPoints>)
      if (!drifts_) own = either(own, both(corners_behind(run.lower), corners_behind(run.upper)));
    return either(outside_, own);
  }

  /// Lower bound for the points of a run's solid with feet beyond its ends: as OutlineRuns::beyond_ends.
  HWY_INLINE V beyond(const OutlineRuns::Run& run) const {
    if (!run.lower.narrow && !run.upper.narrow) return set(kInfinity);
    if (drifts_) return set(-kInfinity);
    const V ax = set(frame_.axis.x), ay = set(frame_.axis.y), az = set(frame_.axis.z);
    const V low_rho = max(zero(), add(at_.rho, corners_.least(radial_.x, radial_.y, radial_.z)));
    const V low_z = add(at_.z, corners_.least(ax, ay, az)),
            high_z = sub(at_.z, corners_.least(hn::Neg(ax), hn::Neg(ay), hn::Neg(az)));
    V low = set(kInfinity);
    for (const OutlineRuns::End* end : {&run.lower, &run.upper}) {
      if (!end->narrow) continue;
      const V y = set(end->point.y), low_in = sub(low_z, y), high_in = sub(high_z, y);
      const bool lower = end == &run.lower;
      const V first = lower ? low_in : hn::Neg(high_in), last = lower ? high_in : hn::Neg(low_in);
      const V in = sub(set(end->point.x), low_rho), along = set(std::abs(end->way.y));
      const V out = mul(set(-end->way.x), in);
      const M some = both(both(hn::Ge(last, zero()), hn::Gt(in, zero())), hn::Ge(out, mul(along, first)));
      const V deep = end->way.y == 0 ? last : min(last, mul(set(-end->way.x / std::abs(end->way.y)), in));
      low = min(low, pick(some, hn::Neg(sqrt(squared(in, deep))), set(kInfinity)));
    }
    return low;
  }

  /// The plane's values at the corners.
  HWY_INLINE CornerValues at_corners(const Plane& plane) const {
    const V x = in_space(plane.out, radial_.x, plane.up, frame_.axis.x),
            y = in_space(plane.out, radial_.y, plane.up, frame_.axis.y),
            z = in_space(plane.out, radial_.z, plane.up, frame_.axis.z);
    CornerValues out;
    out.x = x, out.y = y, out.z = z;
    for (int i = 0; i < 3; ++i)
      out.at[i] = add(plane.distance, dot3(x, y, z, corners_.x[i], corners_.y[i], corners_.z[i]));
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
  static constexpr double kBeforeDisc = 1e-9;  // mm

  static HWY_INLINE V in_space(V out, V radial, V up, double axis) { return add(mul(out, radial), mul(up, set(axis))); }

  /// Whether a triangle lies behind the end of a run, from its corners alone: as TriangleSearch::in_sector.
  HWY_INLINE M corners_behind(const OutlineRuns::End& end) const {
    M out = hn::Le(zero(), zero());
    if (!end.narrow) return out;
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

  HWY_INLINE V extent(V x, V y, V z) const { return drifts_ ? least_drifting(x, y, z) : corners_.least(x, y, z); }

  /// Lowest value of the corners along a direction with drift: a corner's displacement along the direction is that of
  /// the centre plus a term from its offset.
  HWY_INLINE V least_drifting(V x, V y, V z) const {
    const Drift& d = drifts_->drift;
    // (turn × q) · g = (g × turn) · q
    const V hx = sub(mul(y, set(d.turn.z)), mul(z, set(d.turn.y))),
            hy = sub(mul(z, set(d.turn.x)), mul(x, set(d.turn.z))),
            hz = sub(mul(x, set(d.turn.y)), mul(y, set(d.turn.x)));
    const V centre = add(dot(x, y, z, d.way), dot3(hx, hy, hz, at_.x, at_.y, at_.h));
    V low = set(kInfinity);
    if constexpr (std::is_same_v<Extent, FromPoints>) {
      for (int i = 0; i < 3; ++i) {
        const V down = dot3(x, y, z, corners_.x[i], corners_.y[i], corners_.z[i]);
        const V along = add(centre, dot3(hx, hy, hz, corners_.x[i], corners_.y[i], corners_.z[i]));
        low = min(low, sub(down, abs(along)));
      }
    } else {
      low = sub(corners_.least(x, y, z), add(abs(centre), corners_.widest(hx, hy, hz)));
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

}  // namespace

}  // namespace riffler::collide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
