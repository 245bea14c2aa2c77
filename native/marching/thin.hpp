// Material that a mesh leaves out, since it is thinner than the pitch.
#pragma once

#include "dexel/volume.hpp"

namespace riffler {

/// Share of a volume that may be thin without sheets of it and counts as crumbs: edges, and roundings that rays graze.
inline constexpr double kCrumbs = 0.01;

struct ThinMaterial {
  double volume = 0;    ///< mm³
  Box3 box;             ///< where it is; empty where there are crumbs only
  double pitch = 0;     ///< mm: one that keeps nine tenths of it; 0 where there are crumbs only
  bool sheets = false;  ///< some of it is wide: three rays and more across, both ways
};

/// The spans of a tri-dexel volume that hold no point of the lattice which `to_mesh` works on: plates, fins and edges
/// thinner than the pitch, as the direction that sees most of them has them. Rounded shapes have some of them, too,
/// where rays graze them; those make no sheets. Nothing for volumes of one direction, whose floors are kept. Costs a
/// look at every span.
ThinMaterial thin_material(const Volume& volume);

}  // namespace riffler
