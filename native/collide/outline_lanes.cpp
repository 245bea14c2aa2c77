#include "collide/outline_lanes.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "collide/outline_lanes.cpp"
// foreach_target.h must stay here; clang-format would sort it.
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

#include "collide/outline_bounds-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace riffler::collide::HWY_NAMESPACE {

using namespace base::HWY_NAMESPACE;

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
    LeastOfRuns least;
    for (const OutlineRuns::Run& run : runs.all())
      run.reach < kInfinity
          ? least.add_run(runs_at.by_ball(outline[run.first]))
          : least.add_run(runs_at.by_plane(runs_at.plane_of(run, outline)), runs_at.holds(run), runs_at.beyond(run));
    hn::StoreU(max(least.bound(), runs_at.by_sphere()), kD, low + k);
  }
}

void BoxBounds(const OutlineRuns& runs, std::span<const LaneEdge> outline, const ToolFrame& frame,
               const OrientedBoxes& boxes, const Drift* drift, double* low, double* high) {
  const Drifts drifts(drift ? *drift : Drift());
  for (int k = 0; k < base::kLanes; k += lanes()) {
    const FromBoxes extent(boxes, k, frame, outline);
    const Centres at(frame, extent.x, extent.y, extent.z);
    Points points(at.rho, at.z);
    for (const LaneEdge& e : outline) e.arc ? points.add_arc(e) : points.add_line(e);
    const V distance = points.distance();
    const RunBound runs_at(frame, at, extent, extent.reach, distance, drift ? &drifts : nullptr);
    LeastOfRuns least;
    for (const OutlineRuns::Run& run : runs.all())
      run.reach < kInfinity
          ? least.add_run(runs_at.by_ball(outline[run.first]))
          : least.add_run(runs_at.by_plane(runs_at.plane_of(run, outline)), runs_at.holds(run), runs_at.beyond(run));
    hn::StoreU(max(least.bound(), runs_at.by_sphere()), kD, low + k);
    hn::StoreU(add(distance, extent.reach), kD, high + k);
  }
}

}  // namespace riffler::collide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace riffler::collide {

HWY_EXPORT(CentreDistances);
HWY_EXPORT(TriangleBounds);
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
                const OrientedBoxes& boxes, const Drift* drift, double* low, double* high) {
  HWY_DYNAMIC_DISPATCH(BoxBounds)(runs, outline, frame, boxes, drift, low, high);
}

}  // namespace riffler::collide

#endif
