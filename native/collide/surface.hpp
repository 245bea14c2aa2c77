// The triangles of a part or fixture in a sphere tree: flat ones, or chords of an exact surface.
#pragma once

#include <vector>

#include "collide/oriented_boxes.hpp"
#include "collide/sphere_tree.hpp"
#include "collide/triangle_search.hpp"
#include "nurbs/exact_triangles.hpp"
#include "riffler/mesh/mesh.hpp"

namespace riffler::collide {

/// The same surface with large triangles cut into pieces no longer than `most` (mm), because one plane is a poor bound
/// for a large triangle where the tool's shape changes. Pieces with less area than most² / 4 may be four times as long.
/// Neighbouring pieces need not share the new vertices. Doubles `most` until the pieces number at most kMorePieces more
/// than twice the triangles.
Mesh divided(const Mesh& mesh, double most);
constexpr std::size_t kMorePieces = 50'000;
/// Whether the mesh has an edge longer than `most` (mm).
bool is_longer(const Mesh& mesh, double most);

class Surface {
 public:
  explicit Surface(const Mesh& mesh) : Surface(corners_of(mesh), {}) {}
  /// Keeps a reference. Spheres and boxes contain the exact surface, corners are those of the chords.
  explicit Surface(const nurbs::ExactTriangles& exact);

  const SphereTree& tree() const { return tree_; }
  /// Corners by place in the tree. The kLanes places after the last are readable too.
  const Corners& corners(std::size_t place) const { return corners_[place]; }
  /// The boxes of the children of a group that holds no items.
  const OrientedBoxes& boxes(std::size_t group) const { return boxes_[group]; }
  std::size_t size() const { return tree_.size(); }

  /// The exact surface, or null: triangles are flat.
  const nurbs::ExactTriangles* exact() const { return exact_; }
  const nurbs::ExactTriangle& exact(std::size_t place) const { return exact_->triangles[tree_.order()[place]]; }
  /// Largest distance (mm) of the exact surface from the triangle at a place, readable as corners(); only with exact().
  double chord(std::size_t place) const { return chords_[place]; }
  /// The largest of all, 0 for flat triangles.
  double max_chord() const { return max_chord_; }

 private:
  Surface(const std::vector<Corners>& corners, const std::vector<double>& chords);
  static std::vector<Corners> corners_of(const Mesh& mesh);

  SphereTree tree_;
  std::vector<Corners> corners_;
  std::vector<OrientedBoxes> boxes_;
  const nurbs::ExactTriangles* exact_ = nullptr;
  std::vector<double> chords_;  // by place
  double max_chord_ = 0;
};

}  // namespace riffler::collide
