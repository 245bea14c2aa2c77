// What it costs to make the two ends of an edge one vertex, and where that vertex would be.
#pragma once

#include <vector>

#include "mesh/decimate/half_edge.hpp"
#include "mesh/decimate/quadric.hpp"
#include "riffler/base/progress.hpp"

namespace riffler::mesh {

/// The vertex at which `half` starts goes, the one where it ends is then at `point`.
struct CollapseTarget {
  OpenMesh::HalfedgeHandle half;  // invalid where the edge has to stay
  Vec3 point{0};
  bool between = false;  // `point` is not that of the end
  double cost = 0;
};

/// Quadrics of all vertices, and the costs of all edges that follow from them.
class EdgeCosts {
 public:
  /// `centre` was subtracted from the float32 coordinates of a file; `grain` is how far at
  /// most a number is from the next of these; if infinite, vertices do not move.
  EdgeCosts(const HalfEdges& half_edges, const Vec3& centre, double grain, const Progress& progress = {});

  /// The cheapest place for the two ends of `edge`: a vertex's, or one that a file can hold.
  CollapseTarget place(OpenMesh::EdgeHandle edge) const { return place(edge, true); }
  /// The last cost computed; infinite where the edge has to stay or was put off.
  float operator[](OpenMesh::EdgeHandle edge) const { return cost_[edge.idx()]; }
  /// Computes the cost of `edge` anew.
  void refresh(OpenMesh::EdgeHandle edge);
  /// Until it is computed anew the edge costs infinitely much.
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
  std::vector<Kind> kind_;  // of the vertices
  std::vector<Quadric> quadric_;
  std::vector<float> cost_;
};

}  // namespace riffler::mesh
