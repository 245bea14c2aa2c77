// Material that a mesh leaves out, since it is thinner than the pitch.
#pragma once

#include "riffler/dexel/volume.hpp"

namespace riffler::marching {

struct ThinMaterial {
  double volume = 0;     ///< mm³
  Box3 box;              ///< where it is; empty where there is none
  double pitch = 0;      ///< mm: one that keeps nine tenths of it
  bool notable = false;  ///< more than crumbs: four rays see it, or it is more than a hundredth of all
};

/// The spans of a tri-dexel volume that hold no point of the lattice which `to_mesh` works on, nor lie beside one that
/// does: plates, floors and fins thinner than the pitch, as the direction that sees most of them has them. What lies
/// beside a lattice point in the same material, as at a sharp edge or where rays graze a rounding, counts only next to
/// such spans. Nothing for volumes of one direction, whose floors are kept. Costs a look at every span.
ThinMaterial thin_material(const Volume& volume);

}  // namespace riffler::marching
