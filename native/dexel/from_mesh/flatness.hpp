// Detects meshes that enclose no volume.
#pragma once

#include "riffler/mesh/mesh.hpp"

namespace riffler::dexel {

/// Whether all vertices used by triangles lie within `tolerance` (mm) of one plane.
bool is_flat(const Mesh& mesh, double tolerance);

}  // namespace riffler::dexel
