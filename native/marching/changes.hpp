// Finds the bricks of a mesh in which two states of a volume differ.
#pragma once

#include <vector>

#include "marching/bricks.hpp"
#include "riffler/dexel/volume.hpp"

namespace riffler::marching {

struct Changes {
  std::vector<bool> signs;   // bricks with a point between the changed ends of a ray
  std::vector<bool> meshes;  // bricks whose vertices or quads may depend on such a point
  std::vector<std::size_t> sign_bricks, mesh_bricks;

  explicit Changes(std::size_t bricks) : signs(bricks), meshes(bricks) {}
  bool empty() const { return mesh_bricks.empty(); }
};

/// Compares the rays of tiles that the two volumes do not share. Both must have the same frame.
Changes changes_between(const Volume& before, const Volume& after, const Lattice& lattice, const Bricks& bricks);

}  // namespace riffler::marching
