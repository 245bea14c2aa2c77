// Computes a mesh's box and volume in one pass.
#pragma once

#include "riffler/mesh/mesh.hpp"

namespace riffler::mesh {

/// Result of `measure`.
struct Measures {
  Box3 box;           ///< same as `bounds`
  double volume = 0;  ///< mm³, signed; computed about a vertex, so slightly less exact than `volume`
};

/// Box and volume of the vertices that triangles use.
Measures measure(const Mesh& mesh);

}  // namespace riffler::mesh
