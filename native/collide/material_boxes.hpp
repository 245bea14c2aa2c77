// The material of a volume as boxes, over which a fixture's force is summed.
#pragma once

#include <vector>

#include "collide/box_lanes.hpp"
#include "collide/sphere_tree.hpp"
#include "riffler/dexel/volume.hpp"

namespace riffler::collide {

/// Cubic cells of k × k rays, with k such that the cell size is nearest to the wanted spacing. A cell's box encloses
/// all its material, with rays taken as square columns, and has the density that preserves the volume. Up to 8³ full
/// cells become one box. The same for any number of threads.
class MaterialBoxes {
 public:
  /// `spacing`: mm, positive.
  MaterialBoxes(const Volume& volume, double spacing);

  /// Side of a cell, mm.
  double spacing() const { return spacing_; }
  std::size_t size() const { return tree_.size(); }
  /// The tree over the boxes. Each node's centre is the centroid of its material.
  const SphereTree& tree() const { return tree_; }
  /// Boxes per tree group. Only groups that hold items have sides; all have volumes.
  const BoxGroup& boxes(std::size_t group) const { return boxes_[group]; }

 private:
  struct Piece {
    Box3 box;
    double volume;
  };
  class Brick;
  MaterialBoxes(const std::vector<Piece>& pieces, double spacing);
  static double cell_of(const Volume& volume, double spacing);
  static std::vector<Piece> pieces_of(const Volume& volume, double spacing);

  double spacing_;
  SphereTree tree_;
  std::vector<BoxGroup> boxes_;
};

}  // namespace riffler::collide
