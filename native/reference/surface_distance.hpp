// The least signed distance of a surface of triangles from a tool at rest, by two ways that share nothing with
// native/collide: points spread over the surface, and branch and bound over every triangle.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "reference/assembly_distance.hpp"

namespace riffler::reference {

/// At least `count` points, the middles of equal small triangles into which each is cut; every point of the surface is
/// within `spacing` of one of them.
struct SpreadPoints {
  std::vector<Vec3> points;
  double spacing = 0;  ///< mm
};
SpreadPoints spread_points(std::span<const Corners> triangles, std::size_t count);

/// The least distance over the points: the surface's is at most that, and at least that less the spacing, since
/// a distance changes by no more than the point moves.
double least_over(std::span<const Vec3> points, const AssemblyDistance& tool, const Pose& pose);

/// The surface's least distance lies in it.
struct SurfaceBracket {
  double lower;  ///< by branch and bound, mm
  double upper;  ///< attained at `point`, mm: polished there by a direct search
  Vec3 point;
};
/// Cuts triangles in four, those first that may reach lowest, until upper − lower is at most `gap` or `most` of them
/// have been looked at: then lower is what is proven so far.
SurfaceBracket least_distance(std::span<const Corners> triangles, const AssemblyDistance& tool, const Pose& pose,
                              double gap, std::size_t most = 10'000'000);

}  // namespace riffler::reference
