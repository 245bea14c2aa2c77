// Smooths a mesh without changing its triangles.
#pragma once

#include <optional>

#include "riffler/base/progress.hpp"
#include "riffler/mesh/mesh.hpp"

namespace riffler::mesh {

/// rad. An edge whose two triangle normals differ by more is a feature edge.
inline constexpr double kFeatureAngle = 0.7;

/// Runs `iterations` rounds of Taubin's λ|μ smoothing (SIGGRAPH 95, λ = 0.5, μ = -0.51), which keeps the size where
/// plain averaging shrinks. The remaining change of enclosed volume is undone along the normals, in proportion to how
/// far each vertex has moved. Features stay: a vertex on a line of feature edges moves along that line only; a vertex
/// where such lines meet or turn by more than 60° does not move.
///
/// No vertex moves farther than `tolerance` (mm) in total, if given. Vertices on borders and at non-manifold edges or
/// vertices do not move. A vertex also stays if its move would turn a triangle over, reduce one to zero area, fold one
/// onto a neighbour, or make two vertices equal in float32. The bytes are the same for any number of threads.
///
/// Throws std::invalid_argument if `validate` does, for a negative number of iterations, a tolerance that is negative
/// or not finite, or a `feature_angle` (rad) outside (0, π].
Mesh smooth(const Mesh& mesh, int iterations, std::optional<double> tolerance, double feature_angle,
            const Progress& progress = {});
/// Same, with kFeatureAngle.
Mesh smooth(const Mesh& mesh, int iterations, std::optional<double> tolerance = {}, const Progress& progress = {});

}  // namespace riffler::mesh
