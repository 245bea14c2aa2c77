// One half-edge collapse: what it would change, and whether it may.
#pragma once

#include <vector>

#include "geom/vec.hpp"
#include "mesh/half_edge.hpp"

namespace riffler {

/// The collapse of `from` into `to` along a half-edge. prepare gathers it and decides; the rest describes the last
/// prepared one.
///
/// The ring are the neighbours of `from` in counter-clockwise order; old face i is (from, ring[i], ring[i + 1]), and
/// the faces first … last of them become the new faces (to, ring[i], ring[i + 1]). The others vanish.
class Collapse {
 public:
  explicit Collapse(HalfEdgeMesh& mesh) : mesh_(mesh), stamps_(mesh.n_vertices(), 0) {}

  /// False where the mesh would not stay a manifold, a border would leave its line of vertices, or a triangle would
  /// turn over, lose its area or fold onto a neighbour.
  bool prepare(OpenMesh::HalfedgeHandle half);
  void commit() { mesh_.collapse(half_); }

  OpenMesh::VertexHandle from() const { return from_; }
  OpenMesh::VertexHandle to() const { return to_; }
  const Vec3& old_point() const { return old_; }
  const Vec3& new_point() const { return new_; }
  int faces_lost() const { return lost_; }

  int ring_size() const { return static_cast<int>(ring_.size()); }
  /// i may be ring_size(): the ring is closed, unless `from` is on a border.
  const Vec3& ring(int i) const { return points_[wrap(i)]; }
  OpenMesh::VertexHandle ring_vertex(int i) const { return mesh_.to_vertex_handle(ring_[wrap(i)]); }
  /// The half-edge from `from` to ring(i), and the face between it and the next; commit turns them into those of `to`.
  OpenMesh::HalfedgeHandle spoke(int i) const { return ring_[wrap(i)]; }
  OpenMesh::FaceHandle face(int i) const { return faces_[i]; }
  int old_faces() const { return static_cast<int>(faces_.size()); }
  int first() const { return first_; }
  int last() const { return last_; }
  /// Twice the area, times the normal, of old and of new face i.
  const Vec3& old_cross(int i) const { return old_cross_[i]; }
  const Vec3& new_cross(int i) const { return new_cross_[i]; }
  bool on_border() const { return border_; }
  /// The ring's index of `to`.
  int target() const { return target_; }

 private:
  int wrap(int i) const { return i == ring_size() ? 0 : i; }
  bool keeps_borders() const;
  bool keeps_manifold();
  void gather();
  bool keeps_shape();
  bool folds(int i, OpenMesh::HalfedgeHandle across) const;

  HalfEdgeMesh& mesh_;
  std::vector<unsigned> stamps_;  // vertices marked by the last test carry its number
  unsigned stamp_ = 0;
  OpenMesh::HalfedgeHandle half_;
  OpenMesh::VertexHandle from_, to_;
  Vec3 old_, new_;
  std::vector<OpenMesh::HalfedgeHandle> ring_;
  std::vector<OpenMesh::FaceHandle> faces_;
  std::vector<Vec3> points_, old_cross_, new_cross_;
  bool border_ = false;
  int first_ = 0, last_ = -1, target_ = 0, lost_ = 0;
};

}  // namespace riffler
