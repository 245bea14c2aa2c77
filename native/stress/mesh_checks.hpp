// Checks of a volume's mesh, and reduction of a volume that fails a check.
#pragma once

#include <functional>

#include "riffler/mesh/mesh.hpp"
#include "stress/checks.hpp"

namespace riffler::stress {

/// Meshes the volume, rounds to float32 and welds. Checks that the mesh is closed and two-manifold, without triangles
/// that have no area, occur twice or fold onto another, and that its volume is within what the cells at the surface
/// allow. `threads`: also checks that 1 and 4 threads give the same bytes. Writes the number of triangles.
Problem check_mesh(const Volume& volume, bool threads, std::size_t* triangles = nullptr);

/// Compares a mesh that was made with a tolerance, in mm, with the full mesh. Checks that it is closed and two-manifold
/// after rounding to float32; that points spread over each of the two, and all their vertices, are within the tolerance
/// of the other one, by a distance that shares no code with the mesher; and that the enclosed volumes differ by at most
/// the area times the tolerance.
Problem check_within(const Mesh& mesh, const Mesh& full, double tolerance);

/// The same for the volume's meshes with and without the tolerance. `threads`: also checks that 1 and 4 threads give
/// the same bytes. Writes the number of triangles.
Problem check_tolerance(const Volume& volume, double tolerance, bool threads, std::size_t* triangles = nullptr);

/// Removes spans from the volume, at the end one by one, while `fails` stays true.
Volume minimised(const Volume& volume, const std::function<bool(const Volume&)>& fails);

}  // namespace riffler::stress
