// Separates vertices that would coincide in a file.
#pragma once

#include <vector>

#include "riffler/mesh/mesh.hpp"

namespace riffler::mesh {

/// Moves vertices marked in `movable` by a few float32 steps if they would equal another vertex in float32. No triangle
/// turns over; a vertex without a suitable place stays. Other vertices never move, even if they coincide.
void separate(Mesh& mesh, const std::vector<char>& movable);

/// Maximum distance by which `separate` moves a vertex if no coordinate exceeds `largest`, mm.
double separation_reach(double largest);

}  // namespace riffler::mesh
