// The cost of an edge collapse and the position of the merged vertex.
#pragma once

#include <vector>

#include "mesh/decimate/half_edge.hpp"
#include "mesh/decimate/quadric.hpp"
#include "riffler/base/progress.hpp"

namespace riffler::mesh {

/// Removes the vertex where `half` starts and moves the one where it ends to `point`.
struct CollapseTarget {
  OpenMesh::HalfedgeHandle half;  // invalid if the edge must not collapse
  Vec3 point{0};
  bool between = false;  // `point` differs from both ends
  double cost = 0;
};

/// The quadrics of all vertices, and the edge costs derived from them.
class EdgeCosts {
 public:
  /// `centre` has been subtracted from the file's float32 coordinates. `grain` is the largest distance from a number to
  /// the nearest float32 coordinate; if infinite, vertices do not move.
  EdgeCosts(const HalfEdges& half_edges, const Vec3& centre, double grain, const Progress& progress = {});

  /// The cheapest position for the merged vertex of `edge`: that of a vertex, or a position that a file can store.
  CollapseTarget place(OpenMesh::EdgeHandle edge) const { return place(edge, true); }
  /// The last computed cost; infinite if the edge must not collapse or was postponed.
  float operator[](OpenMesh::EdgeHandle edge) const { return cost_[edge.idx()]; }
  /// Recomputes the cost of `edge`.
  void refresh(OpenMesh::EdgeHandle edge);
  /// Postpones the edge: its cost is infinite until refresh().
  void put_off(OpenMesh::EdgeHandle edge);
  void merge(OpenMesh::VertexHandle gone, OpenMesh::VertexHandle into) { quadric_[into.idx()] += quadric_[gone.idx()]; }

 private:
  enum Kind : char { Free, Border, Fixed };

  void add_faces_of(OpenMesh::VertexHandle v);
  CollapseTarget place(OpenMesh::EdgeHandle edge, bool rounded) const;
  CollapseTarget free_place(OpenMesh::HalfedgeHandle half, bool rounded) const;

  const HalfEdgeMesh& mesh_;
  Vec3 centre_;
  double noise_;
  std::vector<Kind> kind_;  // of each vertex
  std::vector<Quadric> quadric_;
  std::vector<float> cost_;
};

}  // namespace riffler::mesh
