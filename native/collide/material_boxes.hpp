// The material of a volume as boxes, each for a piece of it: what a fixture's force is summed over.
#pragma once

#include <vector>

#include "collide/box_lanes.hpp"
#include "collide/sphere_tree.hpp"
#include "riffler/dexel/volume.hpp"

namespace riffler::collide {

/// Cells of k × k rays, as long as they are wide, k such that this is nearest to the wanted spacing. A cell's box goes
/// round all material in it, square rays included, and is as dense as that fills it; where cells are full, up to 8³ of
/// them are one box. The same for any number of threads.
class MaterialBoxes {
 public:
  /// spacing: mm, positive.
  MaterialBoxes(const Volume& volume, double spacing);

  /// Side of a cell, mm.
  double spacing() const { return spacing_; }
  std::size_t size() const { return tree_.size(); }
  /// Nodes have their centre where the middle of their material is.
  const SphereTree& tree() const { return tree_; }
  /// By the tree's groups; only those that hold items have sides, all have volumes.
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
