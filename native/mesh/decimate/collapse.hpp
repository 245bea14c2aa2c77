// One edge collapse: its effect on the mesh, and whether it is allowed.
#pragma once

#include <vector>

#include "mesh/decimate/edge_costs.hpp"
#include "mesh/decimate/half_edge.hpp"
#include "riffler/geom/vec.hpp"

namespace riffler::mesh {

/// Merges the two ends of an edge into one vertex. `prepare` collects the affected faces and decides; all other
/// functions refer to the collapse prepared last.
///
/// `from` is removed; `to` stays and may move. The ring holds the vertices around the changing faces,
/// counter-clockwise: the neighbours of `from` (including `to`) or, if `to` moves, the neighbours of both. Old face i
/// has the edge from ring(i) to ring(i + 1). The old faces first … last become the new faces (to, ring(i), ring(i +
/// 1)); the other old faces vanish.
class Collapse {
 public:
  explicit Collapse(HalfEdgeMesh& mesh) : mesh_(mesh) {}

  /// Returns false if the mesh would not stay a manifold, a border would leave its line of vertices, or a triangle
  /// would turn over, lose its area or fold onto a neighbour.
  bool prepare(const CollapseTarget& placement);
  void commit();

  /// Calls visit(half-edge) for each half-edge that starts at v.
  template <class Visit>
  void for_each_spoke(OpenMesh::VertexHandle v, const Visit& visit) const {
    const OpenMesh::HalfedgeHandle start = mesh_.halfedge_handle(v);
    OpenMesh::HalfedgeHandle spoke = start;
    do {
      visit(spoke);
      spoke = mesh_.opposite_halfedge_handle(mesh_.prev_halfedge_handle(spoke));
    } while (spoke != start);
  }

  OpenMesh::VertexHandle from() const { return from_; }
  OpenMesh::VertexHandle to() const { return to_; }
  const Vec3& from_point() const { return from_point_; }
  const Vec3& to_point() const { return to_point_; }
  const Vec3& new_point() const { return new_; }
  bool between() const { return between_; }
  int faces_lost() const { return lost_; }

  int ring_size() const { return static_cast<int>(ring_.size()); }
  /// i may be ring_size(): the ring is closed unless `from` is on a border.
  const Vec3& ring(int i) const { return ring_[wrap(i)].point; }
  OpenMesh::VertexHandle ring_vertex(int i) const { return ring_[wrap(i)].vertex; }
  /// A half-edge that ends at ring(i); it starts at `from` or `to`.
  OpenMesh::HalfedgeHandle spoke(int i) const { return ring_[wrap(i)].spoke; }
  OpenMesh::FaceHandle face(int i) const { return faces_[i].handle; }
  int old_faces() const { return static_cast<int>(faces_.size()); }
  int first() const { return first_; }
  int last() const { return last_; }
  /// Cross product of two edges of old or new face i (twice the area times the normal); new_cross is 0 if the face
  /// vanishes.
  const Vec3& old_cross(int i) const { return faces_[i].old_cross; }
  const Vec3& new_cross(int i) const { return faces_[i].new_cross; }
  bool on_border() const { return border_; }
  /// Index of `to` in the ring, if `to` does not move.
  int target() const { return target_; }

 private:
  struct Place {
    OpenMesh::HalfedgeHandle spoke;
    OpenMesh::VertexHandle vertex;
    Vec3 point;
  };
  struct Face {
    OpenMesh::FaceHandle handle;
    OpenMesh::HalfedgeHandle outer;  // the half-edge opposite the apex
    Vec3 old_cross, new_cross;
    double longest;  // longest edge of the old face, squared
  };

  int wrap(int i) const { return i == ring_size() ? 0 : i; }
  bool has_few_spokes(OpenMesh::VertexHandle v) const;
  bool keeps_borders() const;
  bool keeps_manifold();
  bool ring_is_simple();
  void gather_fan();
  void gather_both_fans();
  void add_spoke(OpenMesh::HalfedgeHandle spoke);
  void add_face(OpenMesh::HalfedgeHandle spoke, const Vec3& apex, const Vec3& a, const Vec3& b);
  bool keeps_shape();
  bool keeps_angles() const;
  bool folds(int i, int j) const;
  void close_side(OpenMesh::HalfedgeHandle kept, OpenMesh::HalfedgeHandle gone);

  HalfEdgeMesh& mesh_;
  OpenMesh::HalfedgeHandle half_;
  OpenMesh::VertexHandle from_, to_;
  Vec3 from_point_, to_point_, new_;
  bool between_ = false;
  std::vector<Place> ring_;
  std::vector<Face> faces_;
  std::vector<int> marked_;
  bool border_ = false, to_border_ = false;
  int first_ = 0, last_ = -1, target_ = 0, lost_ = 0;
};

}  // namespace riffler::mesh
