// A surface in pieces that can be worked on at the same time.
#pragma once

#include <vector>

#include "mesh/decimate/half_edge.hpp"
#include "riffler/base/progress.hpp"

namespace riffler::mesh {

/// Splits the vertices into boxes of equal numbers. `inner` are vertices all of whose neighbours are in their own
/// patch: what is done to them and between them touches nothing that another patch reads or writes.
class Patches {
 public:
  /// `frame` turns the boxes: the seams of two frames only cross. The pieces do not depend on the number of threads.
  Patches(const HalfEdgeMesh& mesh, int frame, std::size_t vertices_of_one, const Progress& progress = {});

  std::size_t size() const { return begin_.size() - 1; }
  bool inner(OpenMesh::VertexHandle v) const { return inner_[v.idx()]; }
  /// Calls visit(vertex) for all of a patch.
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
