// Reduces the number of triangles of a mesh.
#pragma once

#include <cstddef>
#include <optional>

#include "riffler/base/progress.hpp"
#include "riffler/mesh/mesh.hpp"

namespace riffler::mesh {

/// Where to stop. At least one limit is required; with both, decimation stops at the first one reached.
struct DecimateLimits {
  std::optional<std::size_t> triangles;  ///< number of triangles to reach
  std::optional<double> tolerance;       ///< mm, maximum distance between old and new surface, in both directions
};

/// Returns a mesh with fewer triangles. Edges collapse one at a time, cheapest first, each to the point with the least
/// sum of squared distances from the planes of the triangles it replaces (quadrics: Garland & Heckbert, SIGGRAPH 97).
/// In planes, on straight edges and at corners that point is a vertex of `mesh`; elsewhere it has float32 coordinates.
///
/// If `mesh` is closed, oriented and two-manifold, so is the result. Vertices stay distinct in float32; no triangle
/// turns over or folds onto a neighbour. Borders keep some of their vertices and stay within the tolerance. Vertices
/// with several fans and ends of non-manifold edges do not move. The result may have more triangles than
/// `limits.triangles` if no further collapse satisfies all this. Triangles that name a vertex twice are dropped. The
/// bytes are the same for any number of threads.
///
/// The tolerance bounds the distance of every point of each surface from the other surface (see MapCheck).
///
/// Throws std::invalid_argument if `validate` does, without a limit, or for a tolerance that is negative or not finite.
Mesh decimate(const Mesh& mesh, const DecimateLimits& limits, const Progress& progress = {});

}  // namespace riffler::mesh
