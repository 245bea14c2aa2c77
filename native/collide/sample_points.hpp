// Points on a surface, each for a piece of it: what the contact force is summed over.
#pragma once

#include <vector>

#include "collide/surface.hpp"

namespace riffler::collide {

/// About `spacing` apart: large triangles are split, dense small ones gathered. A piece stands for its area vector (out
/// of the material) at its centroid, and so does every node of the tree over them: a coarser set of points.
class SamplePoints {
 public:
  /// The area vectors of the eight children of a node, mm².
  struct AreaGroup {
    Vec3 area[base::kLanes]{};
  };
  /// A spacing of 0 is chosen: its square is a hundred-thousandth of the area. std::invalid_argument for one that is
  /// negative, not finite, or so small that there would be more than 50 million.
  SamplePoints(const Surface& surface, double spacing);

  double spacing() const { return spacing_; }
  std::size_t size() const { return tree_.size(); }
  const SphereTree& tree() const { return tree_; }
  const AreaGroup& areas(std::size_t group) const { return areas_[group]; }

 private:
  struct Piece {
    Vec3 centroid, area;
    double size;  // |area| before gathering, for centroids of centroids
  };
  SamplePoints(std::vector<Piece> pieces, double spacing);
  static std::vector<Piece> pieces_of(const Surface& surface, double spacing);
  static void gather(const Surface& surface, std::size_t group, double spacing, std::vector<Piece>& out);

  double spacing_;
  SphereTree tree_;
  std::vector<AreaGroup> areas_;
};

/// What a spacing of 0 stands for.
double chosen_spacing(const Surface& surface, double spacing);

}  // namespace riffler::collide
