#include "collide/lowest_places.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "collide/lowest_places.cpp"
// foreach_target.h must stay here; clang-format would sort it.
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

#include "collide/outline_bounds-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace riffler::collide::HWY_NAMESPACE {

using namespace base::HWY_NAMESPACE;

namespace {

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

/// The distance near a point to second order: curved around the axis and along the outline, and along the normal, too,
/// by the larger of both curvatures. The distance itself is straight there, but its minimum is that of a convex
/// function of it, and with this term the square of the distance from a ball's centre or a cylinder's axis is exact:
/// from the side of a ball a step ends at the minimum and not beyond it.
class Quadratic {
 public:
  HWY_INLINE Quadratic(const ToolFrame& frame, const Radial& r, V rho, const Plane& p)
      : around_(hn::Div(max(p.out, zero()), max(rho, set(1e-9)))), along_(p.curvature), across_(max(around_, along_)) {
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
      const V slope = add(dg, bent(t[i], dt, m[i], dm, g[i], dg)), bend = bent(dt, dt, dm, dm, dg, dg);
      const M curved = hn::Gt(bend, set(1e-300));
      const V s = pick(curved, min(max(hn::Div(hn::Neg(slope), pick(curved, bend, set(1))), zero()), set(1)),
                       pick(hn::Lt(slope, zero()), set(1), zero()));
      const V value = add(add(g[i], mul(set(0.5), bent(t[i], t[i], m[i], m[i], g[i], g[i]))),
                          mul(s, add(slope, mul(set(0.5), mul(s, bend)))));
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

  /// The second-order form of two vectors, given by their components around the axis, along the outline and along the
  /// normal.
  HWY_INLINE V bent(V t, V u, V m, V n, V g, V h) const {
    return add(add(mul(around_, mul(t, u)), mul(along_, mul(m, n))), mul(across_, mul(g, h)));
  }

  /// Where the minimum over the whole plane lies within the triangle, it is the place.
  HWY_INLINE void within(const FromPoints& corners, const V* g, const V* t, const V* m, V& x, V& y, V& z) const {
    const V t1 = sub(t[1], t[0]), t2 = sub(t[2], t[0]), m1 = sub(m[1], m[0]), m2 = sub(m[2], m[0]);
    const V g1 = sub(g[1], g[0]), g2 = sub(g[2], g[0]);
    const V a = bent(t1, t1, m1, m1, g1, g1), b = bent(t1, t2, m1, m2, g1, g2), c = bent(t2, t2, m2, m2, g2, g2);
    const V d1 = add(g1, bent(t[0], t1, m[0], m1, g[0], g1)), d2 = add(g2, bent(t[0], t2, m[0], m2, g[0], g2));
    const V det = sub(mul(a, c), mul(b, b));
    const M solvable = hn::Gt(det, mul(set(1e-12), mul(a, c)));
    const V per = hn::Div(set(1), pick(solvable, det, set(1)));
    const V s = mul(per, sub(mul(d2, b), mul(d1, c))), u = mul(per, sub(mul(d1, b), mul(d2, a)));
    const M on = both(both(solvable, hn::Ge(s, zero())), both(hn::Ge(u, zero()), hn::Le(add(s, u), set(1))));
    const auto place = [&](const V* p) { return add(p[0], add(mul(s, sub(p[1], p[0])), mul(u, sub(p[2], p[0])))); };
    x = pick(on, place(corners.x), x), y = pick(on, place(corners.y), y), z = pick(on, place(corners.z), z);
  }

  V around_, along_, across_;  // curvatures, 1/mm
  Direction normal_, meridian_, round_;
};

}  // namespace

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
      LeastOfRuns least;
      V ridge_x = x, ridge_y = y, ridge_z = z;
      M on_ridge = no_lane();
      for (std::size_t j = 0; j < runs.size(); ++j) {
        const OutlineRuns::Run& run = runs.all()[j];
        if (run.reach < kInfinity) {
          least.add_run(runs_at.by_ball(outline[run.first]));
          continue;
        }
        const Plane plane = runs_at.plane_of(run, outline);
        V by_run = runs_at.by_plane(plane);
        M holds = runs_at.holds(run);
        if (j < kKept) {
          const CornerValues values = runs_at.at_corners(plane);
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
        least.add_run(by_run, holds, runs_at.beyond(run));
        const M nearest = hn::Lt(plane.distance, steepest.distance);
        steepest.distance = pick(nearest, plane.distance, steepest.distance);
        steepest.out = pick(nearest, plane.out, steepest.out), steepest.up = pick(nearest, plane.up, steepest.up);
        steepest.curvature = pick(nearest, plane.curvature, steepest.curvature);
      }
      low = pick(active, max(low, max(least.bound(), runs_at.by_sphere())), low);
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

HWY_EXPORT(LowestPlaces);

void lowest_places(const OutlineRuns& runs, std::span<const LaneEdge> outline, const ToolFrame& frame,
                   const Corners* triangles, double enough, double slack, LanePlaces& places) {
  HWY_DYNAMIC_DISPATCH(LowestPlaces)(runs, outline, frame, triangles, enough, slack, places);
}

}  // namespace riffler::collide

#endif
