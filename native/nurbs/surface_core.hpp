// What a Surface keeps: its patches, their Bézier spans, and the tree that the nearest search descends.
#pragma once

#include <vector>

#include "nurbs/bezier.hpp"
#include "nurbs/closest_tree.hpp"
#include "riffler/nurbs/patch.hpp"

namespace riffler::nurbs {

struct SurfaceCore {
  explicit SurfaceCore(std::vector<Patch> given);

  /// The span of a patch at `uv`, which is in the domain. Interior knots belong to the span above them.
  const BezierSpan& span_at(std::size_t patch, const Vec2& uv) const;

  std::vector<Patch> patches;
  Box3 box;      // of the control points
  Vec3 origin;   // nets are relative to it: the box's centre
  double scale;  // largest coordinate, mm: rounding is relative to it
  std::vector<BezierSpan> spans;
  std::vector<std::size_t> first_span;                  // of each patch
  std::vector<std::vector<double>> breaks_u, breaks_v;  // where the spans of each patch begin
  std::vector<TrimRegion> regions;                      // of each patch
  ClosestTree tree;
};

}  // namespace riffler::nurbs
