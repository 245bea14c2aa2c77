// Splits a surface into patches that threads can work on in parallel.
#pragma once

#include <vector>

#include "mesh/decimate/half_edge.hpp"
#include "riffler/base/progress.hpp"

namespace riffler::mesh {

/// Splits the vertices into boxes with equal numbers of vertices. A vertex is `inner` if all its neighbours are in its
/// own patch: changing inner vertices and the edges between them touches nothing that another patch reads or writes.
class Patches {
 public:
  /// `frame` rotates the boxes, so that the seams of two frames only cross. Patches do not depend on the number of
  /// threads.
  Patches(const HalfEdgeMesh& mesh, int frame, std::size_t vertices_of_one, const Progress& progress = {});

  std::size_t size() const { return begin_.size() - 1; }
  bool inner(OpenMesh::VertexHandle v) const { return inner_[v.idx()]; }
  /// Calls visit(vertex) for all vertices of a patch.
  template <class Visit>
  void for_each_vertex(std::size_t patch, const Visit& visit) const {
    for (std::size_t i = begin_[patch]; i < begin_[patch + 1]; ++i) visit(OpenMesh::VertexHandle(order_[i]));
  }

 private:
  void split(const HalfEdgeMesh& mesh, int frame, int levels, const Progress& progress);

  std::vector<int> order_;
  std::vector<std::size_t> begin_;
  std::vector<int> patch_;
  std::vector<char> inner_;
};

}  // namespace riffler::mesh
