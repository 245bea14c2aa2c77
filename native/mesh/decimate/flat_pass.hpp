// Removes the vertices inside planes before edges are queued.
#pragma once

#include "riffler/base/progress.hpp"
#include "riffler/mesh/mesh.hpp"

namespace riffler::mesh {

/// Takes vertices inside planes out of a valid mesh: most of what a volume's mesh has. That needs no queue, no costs
/// and no traces, and takes a tenth of the time. Edges and corners of planes stay, as do all vertices elsewhere.
///
/// `exact` and `local` are the same mesh with different coordinates: `local` decides. A vertex may be `slack` from the
/// plane. Triangles and vertices keep their order. Returns the largest distance, mm, between a point of `local` before
/// and its place afterwards, in both directions: at most 2 √3 `slack` a pass over all of the mesh, of which there are
/// kFlatPasses. The bytes are the same for any number of threads.
double remove_inside_planes(Mesh& exact, Mesh& local, double slack, const Progress& progress = {});

inline constexpr int kFlatPasses = 3;

}  // namespace riffler::mesh
