// Finds material that a mesh omits because it is thinner than the pitch.
#pragma once

#include "riffler/dexel/volume.hpp"

namespace riffler::marching {

/// Material missing from the mesh.
struct ThinMaterial {
  double volume = 0;     ///< mm³
  Box3 box;              ///< bounding box, mm; empty if there is no such material
  double pitch = 0;      ///< mm, a pitch that would keep nine tenths of it
  bool notable = false;  ///< more than crumbs: four rays meet it, or it is more than a hundredth of all material
};

/// Measures the plates, floors and fins of a tri-dexel volume that are thinner than the pitch: spans that contain no
/// point of `to_mesh`'s lattice and have no neighbour that does. The direction that sees most of them counts. A span
/// next to a lattice point in the same material, as at a sharp edge or where rays graze a rounding, counts only if it
/// is adjacent to such spans. Returns nothing for volumes of one direction, whose floors are kept. Visits every span.
ThinMaterial thin_material(const Volume& volume);

}  // namespace riffler::marching
