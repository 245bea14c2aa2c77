// Fewer triangles for the same surface.
#pragma once

#include <cstddef>
#include <optional>

#include "riffler/base/progress.hpp"
#include "riffler/mesh/mesh.hpp"

namespace riffler::mesh {

/// Where to stop; at least one is needed. With both, whatever comes first.
struct DecimateLimits {
  std::optional<std::size_t> triangles;  ///< stop at this many triangles or fewer
  std::optional<double> tolerance;       ///< mm between old and new surface, in both directions
};

/// A mesh like `mesh` with fewer triangles: edges become vertices one after the other, cheapest first, each where the
/// squared distances from the planes of the triangles that it stands for are least (quadrics: Garland & Heckbert,
/// SIGGRAPH 97). In planes, on straight edges and at corners these are vertices of `mesh`; others are float32 numbers.
/// The result is closed, oriented and two-manifold where `mesh` is; vertices stay distinct in float32; no triangle
/// turns over or folds onto a neighbour. Borders keep some of their vertices, and to the tolerance; vertices with
/// several fans and ends of non-manifold edges stay where they are. There may be more triangles left than asked for
/// where no further collapse keeps to all this. Triangles that name a vertex twice are dropped. The bytes are the same
/// for any number of threads.
///
/// The tolerance bounds the distance of every point of either surface from the other (see MapCheck).
///
/// std::invalid_argument where `validate` throws, without a limit, or for a tolerance that is negative or not finite.
Mesh decimate(const Mesh& mesh, const DecimateLimits& limits, const Progress& progress = {});

}  // namespace riffler::mesh
