// The smallest signed distance of a triangle surface from a tool at rest, by two methods that share nothing with
// native/collide: points spread over the surface, and branch and bound over every triangle.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "reference/assembly_distance.hpp"

namespace riffler::reference {

/// At least `count` points: the centroids of equal small triangles into which each triangle is divided. Every point of
/// the surface is within `spacing` of one of them.
struct SpreadPoints {
  std::vector<Vec3> points;
  double spacing = 0;  ///< mm
};
SpreadPoints spread_points(std::span<const Corners> triangles, std::size_t count);

/// The smallest distance over the points. The surface's smallest distance is at most that, and at least that minus the
/// spacing, because a distance changes by no more than the point moves.
double least_over(std::span<const Vec3> points, const AssemblyDistance& tool, const Pose& pose);

/// An interval that contains the surface's smallest distance.
struct SurfaceBracket {
  double lower;  ///< by branch and bound, mm
  double upper;  ///< attained at `point`, which a direct search has refined, mm
  Vec3 point;
};
/// Divides triangles in four, the one with the lowest bound first, until upper − lower is at most `gap`. Stops after
/// `most` triangles with the bound proven so far.
SurfaceBracket least_distance(std::span<const Corners> triangles, const AssemblyDistance& tool, const Pose& pose,
                              double gap, std::size_t most = 10'000'000);

}  // namespace riffler::reference
