// Volume → closed, outward, two-manifold mesh.
#pragma once

#include "riffler/base/progress.hpp"
#include "riffler/dexel/volume.hpp"
#include "riffler/mesh/mesh.hpp"

namespace riffler::marching {

/// The surface of the volume's material. Vertices are exact in float32, distinct, and no two triangles fold onto each
/// other, so a binary STL that is read back and welded is the same closed mesh. The bytes are the same for any number
/// of threads. An empty volume gives an empty mesh. Throws std::invalid_argument where the box lies so far from the
/// origin that float32 cannot tell lattice points apart (|coordinate| ≥ 2²¹ h).
///
/// "xyz": the lattice points that at least two of their three rays call inside are; edges and corners of the material
/// come out sharp. A plate or a gap that lies wholly between two lattice planes is not seen.
/// One direction: walls stand half a pitch from their rays, so slopes steeper than 45° are steps; a floor thinner than
/// the pitch is kept, one of its faces off by up to half a pitch; a gap along a ray thinner than that may close.
Mesh to_mesh(const Volume& volume, const Progress& progress = {});

}  // namespace riffler::marching
