// What must hold for the mesh of any volume, and the least of a volume for which something does not.
#pragma once

#include <functional>

#include "stress/checks.hpp"

namespace riffler::stress {

/// Meshes, rounds to float32 and welds: closed, two-manifold, no triangle without area, twice or folded onto another;
/// volume within what the cells that the surface passes allow. `threads`: the same bytes
/// with 1 thread and with 4. Says how many triangles there were.
Problem check_mesh(const Volume& volume, bool threads, std::size_t* triangles = nullptr);

/// The volume with as many spans taken away as `fails` allows it to stay wrong, one by one at the end.
Volume minimised(const Volume& volume, const std::function<bool(const Volume&)>& fails);

}  // namespace riffler::stress
