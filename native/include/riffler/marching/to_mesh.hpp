// Converts a volume to a closed, outward, two-manifold mesh.
#pragma once

#include <cstddef>

#include "riffler/base/progress.hpp"
#include "riffler/dexel/volume.hpp"
#include "riffler/mesh/mesh.hpp"

namespace riffler::marching {

/// The surface of the volume's material. Vertices are distinct and exact in float32, and no two triangles fold onto
/// each other, so a binary STL that is read back and welded is the same closed mesh. The bytes are the same for any
/// number of threads. An empty volume gives an empty mesh. Throws std::invalid_argument if the box is so far from the
/// origin that float32 cannot distinguish lattice points (|coordinate| ≥ 2²¹ h, h the pitch).
///
/// "xyz": a lattice point is inside if at least two of its three rays contain it; edges and corners of the material
/// come out sharp. A plate or gap that lies entirely between two lattice planes is lost.
///
/// One direction: walls lie half a pitch from their rays, so slopes steeper than 45° become steps. A floor thinner than
/// the pitch is kept, one of its faces displaced by up to half a pitch; a gap along a ray thinner than that may close.
Mesh to_mesh(const Volume& volume, const Progress& progress = {});

/// The same surface without the triangles that its shape does not need: no point of it is farther than `tolerance` (mm)
/// from that of `to_mesh(volume)`, and the reverse. Its vertices are some of that mesh's, and it is closed, outward,
/// two-manifold and sharp at edges like that one, also in a binary STL. The bytes are the same for any number of
/// threads. A tolerance below the step of float32 at the box's largest coordinate, 0 included, gives all triangles; one
/// larger than the part keeps each shell with at least four. `all`, where given, becomes the number of triangles of
/// `to_mesh(volume)`. Throws std::invalid_argument for a tolerance that is negative or not finite.
Mesh to_mesh(const Volume& volume, double tolerance, const Progress& progress = {}, std::size_t* all = nullptr);

}  // namespace riffler::marching
