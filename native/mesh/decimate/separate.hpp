// Vertices that would be one in a file.
#pragma once

#include <vector>

#include "riffler/mesh/mesh.hpp"

namespace riffler::mesh {

/// Moves vertices that `movable` marks by a few steps of float32 at most, where they would otherwise be equal to
/// another vertex in float32. No triangle turns over; where there is no such place the vertex stays. Vertices that are
/// not movable stay, even if they are equal.
void separate(Mesh& mesh, const std::vector<char>& movable);

/// How far `separate` moves a vertex at most, where no coordinate is larger than `largest`.
double separation_reach(double largest);

}  // namespace riffler::mesh
