#include "collide/outline_lanes.hpp"

#include <algorithm>

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

constexpr double kRounding = 1e-8;  // mm: more than coordinates of 1e5 mm lose

void CentreDistances(std::span<const LaneEdge> outline, const ToolFrame& frame, const SphereGroup& spheres,
                     double* distance) {
  for (int k = 0; k < base::kLanes; k += lanes()) {
    const Centres at(frame, spheres, k);
    Points points(at.rho, at.z);
    for (const LaneEdge& e : outline) e.arc ? points.add_arc(e) : points.add_line(e);
    hn::StoreU(points.distance(), kD, distance + k);
  }
}

EdgeSet CentreDistancesAndEdges(std::span<const LaneEdge> outline, const ToolFrame& frame, const SphereGroup& spheres,
                                double* distance) {
  alignas(64) double squares[kEdgeBits][base::kLanes];
  const std::size_t edges = std::min(outline.size(), kEdgeBits);
  EdgeSet out = 0;
  for (int k = 0; k < base::kLanes; k += lanes()) {
    const Centres at(frame, spheres, k);
    Points all(at.rho, at.z);
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const LaneEdge& e = outline[i];
      Points one(at.rho, at.z);
      e.arc ? one.add_arc(e) : one.add_line(e);
      all.square = min(all.square, one.square), all.inside = either(all.inside, one.inside);
      if (i < edges) hn::Store(one.square, kD, squares[i] + k);
    }
    const V d = all.distance(), held = hn::Load(kD, spheres.radius + k);
    hn::StoreU(d, kD, distance + k);
    const M reaches = hn::Lt(d, held);
    if (none(reaches)) continue;
    // The nearest edge of a point is at most two radii farther from the centre than the centre's own.
    const V radius = add(held, set(kRounding)), near = add(hn::Abs(d), mul(set(2), radius)), square = mul(near, near);
    const V low = sub(at.z, radius), high = add(at.z, radius);
    for (std::size_t i = 0; i < edges; ++i) {
      const LaneEdge& e = outline[i];
      M decides = hn::Le(hn::Load(kD, squares[i] + k), square);
      if (e.arc || e.rises) decides = either(decides, both(hn::Ge(high, set(e.from[1])), hn::Le(low, set(e.to[1]))));
      if (!none(both(reaches, decides))) out |= EdgeSet{1} << i;
    }
  }
  return out;
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
      run.reach < kInfinity ? least.add_run(runs_at.by_ball(outline[run.first]))
                            : least.add_run(runs_at.by_plane(runs_at.plane_of(run, outline)), runs_at.holds(run));
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
      run.reach < kInfinity ? least.add_run(runs_at.by_ball(outline[run.first]))
                            : least.add_run(runs_at.by_plane(runs_at.plane_of(run, outline)), runs_at.holds(run));
    hn::StoreU(max(least.bound(), runs_at.by_sphere()), kD, low + k);
    hn::StoreU(add(distance, extent.reach), kD, high + k);
  }
}

}  // namespace riffler::collide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace riffler::collide {

HWY_EXPORT(CentreDistances);
HWY_EXPORT(CentreDistancesAndEdges);
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

EdgeSet centre_distances_and_edges(std::span<const LaneEdge> outline, const ToolFrame& frame,
                                   const SphereGroup& spheres, double* distance) {
  return HWY_DYNAMIC_DISPATCH(CentreDistancesAndEdges)(outline, frame, spheres, distance);
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
