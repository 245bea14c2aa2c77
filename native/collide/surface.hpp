// The triangles of a part or fixture in a sphere tree.
#pragma once

#include <vector>

#include "collide/sphere_tree.hpp"
#include "collide/triangle_search.hpp"
#include "riffler/mesh/mesh.hpp"

namespace riffler::collide {

class Surface {
 public:
  explicit Surface(const Mesh& mesh) : Surface(corners_of(mesh)) {}

  const SphereTree& tree() const { return tree_; }
  /// Corners by place in the tree. The kLanes places after the last are readable too.
  const Corners& corners(std::size_t place) const { return corners_[place]; }
  std::size_t size() const { return tree_.size(); }

 private:
  explicit Surface(const std::vector<Corners>& corners);
  static std::vector<Corners> corners_of(const Mesh& mesh);

  SphereTree tree_;
  std::vector<Corners> corners_;
};

}  // namespace riffler::collide
