// Less roughness, the same triangles.
#pragma once

#include <optional>

#include "riffler/base/progress.hpp"
#include "riffler/mesh/mesh.hpp"

namespace riffler::mesh {

/// Edges whose triangles' normals differ by more are features, rad.
inline constexpr double kFeatureAngle = 0.7;

/// `iterations` rounds of Taubin's λ|μ smoothing (SIGGRAPH 95, λ = 0.5, μ = -0.51), which keeps the size where plain
/// averaging shrinks; what is still missing of the volume enclosed, or too much, is given back along the normals, where
/// vertices have moved and in proportion to it. Features stay: a vertex on a line of feature edges is smoothed along
/// that line, one where such lines meet, or turn by more than 60°, does not move.
///
/// No vertex moves farther than `tolerance` (mm) in all, if there is one. Vertices on borders and at non-manifold edges
/// or vertices stay, and so do those whose triangles would turn over, lose their area or fold onto a neighbour, or that
/// would meet another vertex in float32. The bytes are the same for any number of threads.
///
/// std::invalid_argument where `validate` throws, for fewer than 0 iterations, a tolerance that is negative or not
/// finite, or a `feature_angle` that is not in (0, π].
Mesh smooth(const Mesh& mesh, int iterations, std::optional<double> tolerance, double feature_angle,
            const Progress& progress = {});
/// With kFeatureAngle.
Mesh smooth(const Mesh& mesh, int iterations, std::optional<double> tolerance = {}, const Progress& progress = {});

}  // namespace riffler::mesh
