// A mesh's box and volume in one pass.
#pragma once

#include "riffler/mesh/mesh.hpp"

namespace riffler::mesh {

struct Measures {
  Box3 box;           ///< as `bounds`
  double volume = 0;  ///< mm³, signed; about one of the vertices, so a little less exact than `volume`
};

/// Of the vertices that triangles use.
Measures measure(const Mesh& mesh);

}  // namespace riffler::mesh
