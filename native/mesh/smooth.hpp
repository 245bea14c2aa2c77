// Less roughness, the same triangles.
#pragma once

#include <optional>

#include "geom/progress.hpp"
#include "mesh/mesh.hpp"

namespace riffler {

/// `iterations` rounds of Taubin's λ|μ smoothing (SIGGRAPH 95, λ = 0.5, μ = -0.51), which keeps the size where plain
/// averaging shrinks. No vertex moves farther than `tolerance` (mm) in all, if there is one. Vertices on borders and at
/// non-manifold edges or vertices stay, and so do those whose triangles would turn over, lose their area or fold onto a
/// neighbour, or that would meet another vertex in float32. The bytes are the same for any number of threads.
/// std::invalid_argument where `validate` throws, for fewer than 0 iterations or a tolerance that is negative or not
/// finite.
Mesh smooth(const Mesh& mesh, int iterations, std::optional<double> tolerance = {}, const Progress& progress = {});

}  // namespace riffler
