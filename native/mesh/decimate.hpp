// Fewer triangles for the same surface.
#pragma once

#include <cstddef>
#include <optional>

#include "geom/progress.hpp"
#include "mesh/mesh.hpp"

namespace riffler {

/// Where to stop; at least one is needed. With both, whatever comes first.
struct DecimateLimits {
  std::optional<std::size_t> triangles;  ///< stop at this many triangles or fewer
  std::optional<double> tolerance;       ///< mm between old and new surface, in both directions
};

/// A mesh with some of the vertices of `mesh`, whose edges were collapsed one after the other, cheapest first
/// (quadrics: Garland & Heckbert, SIGGRAPH 97). It is closed, oriented and two-manifold where `mesh` is; vertices stay
/// distinct in float32; no triangle turns over or folds onto a neighbour. Borders stay borders and keep to the
/// tolerance; vertices with several fans and ends of non-manifold edges stay where they are. There may be more
/// triangles left than asked for where no further collapse keeps to all this. Triangles that name a vertex twice are
/// dropped.
///
/// The tolerance bounds the distance of every point of either surface from the other (see ToleranceCheck).
///
/// std::invalid_argument where `validate` throws, without a limit, or for a tolerance that is negative or not finite.
Mesh decimate(const Mesh& mesh, const DecimateLimits& limits, const Progress& progress = {});

}  // namespace riffler
