// Where the surface of a mesh ends: the directed edges that no neighbour takes back.
#pragma once

#include <vector>

#include "mesh/mesh.hpp"

namespace riffler {

/// The boundary of the mesh as closed walks: walk k visits the vertices loops[k][0], loops[k][1], … and returns to the
/// first. Every directed edge stands as often as triangles run through it that way less those that run against it, so
/// a closed mesh has none, and with surfaces that close the walks the mesh is closed. Vertices with equal coordinates
/// count as one. O(n) for closed meshes.
std::vector<std::vector<int>> boundary_loops(const Mesh& mesh);

/// The mesh with cracks joined: of its boundary's vertices, each that lies within `tolerance` (mm) of one before it
/// moves there. What rounding tore apart is closed by this, so that no column has to look for its way between the lips.
Mesh join_cracks(const Mesh& mesh, const std::vector<std::vector<int>>& loops, double tolerance);

}  // namespace riffler
