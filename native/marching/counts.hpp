// Where each crossed edge and each vertex stands in the output, known before any of them is computed.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "marching/cells.hpp"

namespace riffler::marching {

/// A crossed edge of the lattice, from (i, j, k) along `axis`.
struct LatticeEdge {
  int axis, i, j, k;
  bool rising;  // from outside to inside: the material's surface looks down the axis
};

/// Crossed edges are numbered by plane I, then column J, then axis, then K; vertices by cell and cycle. One quad stands
/// for one crossed edge and has its number.
class Counts {
 public:
  /// Throws std::invalid_argument if the mesh would have more triangles than 32-bit indices can tell apart.
  Counts(const Lattice& lattice, const SignField& signs, const Progress& progress);

  std::size_t edges() const { return plane_edge_.back(); }
  std::size_t vertices() const { return plane_vertex_.back(); }
  /// Number of the first edge in a column along an axis.
  std::size_t edge(int i, int j, int axis) const { return plane_edge_[i] + column_[offset(i, j)][axis]; }
  /// Number of the first edge after a column.
  std::size_t edge_after(int i, int j) const { return j + 1 < columns_ ? edge(i, j + 1, 0) : plane_edge_[i + 1]; }
  /// Number of the first vertex in the cells of plane i.
  std::size_t vertex(int i) const { return plane_vertex_[i]; }
  /// The edge of a number: by bisection, for the few that need it.
  LatticeEdge locate(const SignField& signs, std::size_t edge) const;

 private:
  std::size_t offset(int i, int j) const { return static_cast<std::size_t>(i) * columns_ + j; }
  int columns_;
  std::vector<std::array<std::uint32_t, 3>> column_;  // edges of this plane before this column and axis
  std::vector<std::size_t> plane_edge_, plane_vertex_;
};

}  // namespace riffler::marching
