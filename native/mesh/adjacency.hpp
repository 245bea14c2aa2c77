// Finds the triangles that meet at each edge.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "riffler/mesh/mesh.hpp"

namespace riffler::mesh {

/// Half-edge 3 t + k runs from corner k of triangle t to corner k + 1 (mod 3).
inline int triangle_of(int half) {
  return half / 3;
}
inline int next_half(int half) {
  return half % 3 == 2 ? half - 2 : half + 1;
}
inline int previous_half(int half) {
  return half % 3 == 0 ? half + 2 : half - 1;
}
inline int start_of(const Mesh& mesh, int half) {
  return mesh.triangles[half / 3][half % 3];
}
inline int end_of(const Mesh& mesh, int half) {
  return start_of(mesh, next_half(half));
}

/// Whether a triangle names a vertex twice. Such a triangle has no edges here.
inline bool repeats_a_vertex(const Vec3i& t) {
  return t.x == t.y || t.y == t.z || t.z == t.x;
}

/// The half-edges of a valid mesh, sorted by edge.
class EdgeTable {
 public:
  struct Use {
    int upper;           // vertex of the edge with the larger index
    std::uint32_t code;  // 2 × half-edge, + 1 if it runs from the upper to the lower vertex
    int half() const { return static_cast<int>(code >> 1); }
    bool reversed() const { return code & 1; }
  };

  /// Throws std::invalid_argument for more than 715 million triangles.
  explicit EdgeTable(const Mesh& mesh);

  /// Calls visit(lower, uses) once for every edge, in parallel; `uses` are in the order of their half-edges.
  void for_each_edge(const std::function<void(int lower, std::span<const Use> uses)>& visit) const;

 private:
  std::vector<std::uint32_t> begin_;  // by lower vertex
  std::vector<Use> uses_;
};

/// Number of triangles with the same vertices as an earlier one, in any order. Each is counted at the edge of its two
/// lowest vertices, so the sum over all edges counts it once.
std::size_t duplicates_at(const Mesh& mesh, std::span<const EdgeTable::Use> uses);

/// The triangle across each half-edge.
class Adjacency {
 public:
  explicit Adjacency(const Mesh& mesh) : Adjacency(mesh, EdgeTable(mesh)) {}
  Adjacency(const Mesh& mesh, const EdgeTable& edges);

  /// The half-edge of the only other triangle at the edge, if it runs in the opposite direction; otherwise -1.
  int twin(int half) const { return across_[half] >= 0 ? across_[half] : -1; }
  /// Like twin, but also if the other half-edge runs in the same direction.
  int neighbour(int half) const { return across_[half] <= kSameWay ? kSameWay - across_[half] : twin(half); }
  /// No other triangle shares the edge.
  bool is_open(int half) const { return across_[half] == kOpen; }
  /// Two or more other triangles share the edge.
  bool is_crowded(int half) const { return across_[half] == kCrowded; }
  /// The only other triangle runs the edge in the same direction.
  bool is_same_way(int half) const { return across_[half] <= kSameWay; }

 private:
  static constexpr int kOpen = -1, kCrowded = -2, kNoEdge = -3, kSameWay = -4;
  std::vector<int> across_;
};

}  // namespace riffler::mesh
