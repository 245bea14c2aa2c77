// A surface in triangles of its parameters: those between straight chords approximate it, and each knows the exact
// surface above it.
#pragma once

#include <cstdint>
#include <vector>

#include "nurbs/chord_bound.hpp"
#include "nurbs/surface_core.hpp"
#include "riffler/base/progress.hpp"

namespace riffler::nurbs {

/// A part of a span, as a Bézier net.
struct ExactCell {
  Degrees degrees;
  std::size_t net = 0;     // where its control points begin
  SecondDerivatives bend;  // over its unit square
  std::size_t span = 0;
  Vec2 lower{0}, upper{1};  // of the patch's domain
};

/// A triangle in the unit square of a cell, counter-clockwise.
struct ExactTriangle {
  std::uint32_t cell = 0;
  Vec2 uv[3];
};

struct ExactTriangles {
  std::vector<ExactCell> cells;
  std::vector<Vec4> nets;  // relative to `origin`
  std::vector<ExactTriangle> triangles;
  Vec3 origin{0};

  /// A point of the surface, mm.
  Vec3 point(std::uint32_t cell, const Vec2& uv) const {
    const ExactCell& c = cells[cell];
    return origin + affine(point_of(nets.data() + c.net, c.degrees, uv));
  }
  /// Largest distance (mm) between the surface above a triangle of these parameters and the flat triangle.
  double chord(std::uint32_t cell, const Vec2& a, const Vec2& b, const Vec2& c) const {
    const Vec2 side = glm::max(a, glm::max(b, c)) - glm::min(a, glm::min(b, c));
    return cells[cell].bend.chord(side.x, side.y);
  }
};

/// How finely a surface is divided. The chord is proven, by second derivatives.
struct Fineness {
  double chord;                   // mm
  double longest;                 // side of a cell, mm
  double of_size = 1;             // largest chord relative to a cell's size
  std::size_t most = 50'000'000;  // triangles
};
/// Throws std::invalid_argument if more triangles than `most` are necessary.
ExactTriangles exact_triangles(const SurfaceCore& core, const Fineness& fineness, const Progress& progress = {});

}  // namespace riffler::nurbs
