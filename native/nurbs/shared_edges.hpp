// Borders of Bézier spans that are one curve: what lies on both sides of it has the same vertices.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "nurbs/bezier.hpp"

namespace riffler::nurbs {

/// One border curve of one or more spans.
struct SharedEdge {
  std::vector<Vec4> points;          // control points in its own direction
  int begin = 0, end = 0;            // corners
  bool collapsed = false;            // a pole: all of it is the corner `begin`
  std::vector<std::int64_t> places;  // of the vertices between its corners, ascending, in units of 1 / kGrid
};

/// The use of an edge as a span's side. Sides 0 to 3: v = 0, u = 1, v = 1, u = 0; parameters ascend with u or v.
struct EdgeUse {
  int edge = 0;
  bool reversed = false;

  std::int64_t place(std::int64_t at) const;
};

/// All borders of the spans: equal ones, to `weld` (mm), are one.
struct SharedEdges {
  SharedEdges(const std::vector<BezierSpan>& spans, double weld);

  std::vector<Vec3> corners;
  std::vector<SharedEdge> edges;
  std::vector<std::array<EdgeUse, 4>> of_span;
};

}  // namespace riffler::nurbs
