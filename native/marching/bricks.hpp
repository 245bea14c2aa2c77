// The lattice in bricks of 32 × 32 × 32 cells: their signs, and the positions of their quads and vertices in the mesh.
//
// Each brick is meshed by itself, from its rays and the signs around it. It is small enough for the inner caches, and
// large enough that the layer of cells needed from its neighbours costs little.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "marching/lattice.hpp"

namespace riffler::marching {

inline constexpr int kBrickSide = 32;
inline constexpr int kBrickColumns = kBrickSide * kBrickSide;

inline int bricks_along(const Lattice& lattice, int axis) {
  return (lattice.points(axis) + kBrickSide - 1) / kBrickSide;
}

/// Whether each lattice point of a brick is inside: bit K of row 32 I + J.
using SignRows = std::array<std::uint32_t, kBrickColumns>;
/// The common sign of all points of a brick, if there is one.
std::optional<bool> common_sign(const SignRows& rows);

/// A crossed edge of the lattice, from (i, j, k) along `axis`.
struct LatticeEdge {
  int axis, i, j, k;
  bool rising;  // from outside to inside: the surface normal points down the axis
};

/// A quad and the edge that it belongs to.
struct QuadRef {
  std::uint32_t quad;
  LatticeEdge edge;
  bool operator==(const QuadRef& o) const { return quad == o.quad; }
  bool operator<(const QuadRef& o) const { return quad < o.quad; }
};

/// A vertex and the cell that it belongs to.
struct CellVertex {
  std::int32_t vertex;
  Vec3i cell;
  bool operator==(const CellVertex& o) const { return vertex == o.vertex; }
  bool operator<(const CellVertex& o) const { return vertex < o.vertex; }
};

/// A vertex that later stages have to examine; most vertices simply lie in their cell.
struct VertexChoice {
  CellVertex at;
  Vec3 safe;       // for any choice of the neighbours, the quads around it have a valid diagonal here
  Vec3 candidate;  // a better place, or `safe`
  Vec3 anchor;     // target of the pull when triangles fold, cell units
  Vec3 chosen;     // the choice: between `safe` and `candidate`
  Vec3 fallback;   // while triangles are unfolded: `safe`, pulled
  bool alone;      // no other vertex belongs to its cell
};

/// A vertex that was moved to unfold triangles, and its previous place.
struct MovedVertex {
  CellVertex at;
  Vec3 before;
};

/// The one plane of a plain brick (plain_brick.hpp).
struct PlainFace {
  int axis, layer;  // across which it lies, and the place of its edges along it
  float place;      // of the hits on these edges, pitches
  bool rising;      // of these edges
};

/// Data of a brick that the surface runs through, in addition to its signs. Its edges (one quad each) are those that
/// start at its points, numbered by column, axis and K. Its vertices are those of its cells, numbered by column, K and
/// cycle.
struct ActiveBrick {
  Vec3i at;                                                // position in bricks
  std::size_t first_edge = 0, first_vertex = 0;            // mesh index of the first quad and vertex
  std::array<std::uint32_t, kBrickSide + 1> plane_edge{};  // count before each plane I; the last entry: all
  std::array<std::uint32_t, kBrickSide + 1> plane_vertex{};
  std::array<std::uint16_t, kBrickColumns> column_edge{};  // count within its plane before each column
  std::array<std::uint16_t, kBrickColumns> column_vertex{};
  std::vector<VertexChoice> specials;  // by vertex, ascending
  std::vector<QuadRef> suspects;       // quads that may fold onto a neighbour
  std::vector<MovedVertex> pulled;
  std::optional<PlainFace> plain;
  bool hollow = false;  // plain, and only partly made

  std::size_t edges() const { return plane_edge[kBrickSide]; }
  std::size_t vertices() const { return plane_vertex[kBrickSide]; }
  std::size_t edge(int i, int j) const { return first_edge + plane_edge[i] + column_edge[i * kBrickSide + j]; }
  std::size_t vertex(int i, int j) const { return first_vertex + plane_vertex[i] + column_vertex[i * kBrickSide + j]; }
  /// Index after the last vertex of a column.
  std::size_t vertex_after(int i, int j) const {
    return j + 1 < kBrickSide ? vertex(i, j + 1) : first_vertex + plane_vertex[i + 1];
  }
};

class Bricks {
 public:
  /// All points are outside.
  explicit Bricks(const Lattice& lattice);

  int count(int axis) const { return count_[axis]; }
  std::size_t size() const { return bricks_.size(); }
  std::size_t index(int a, int b, int c) const { return (static_cast<std::size_t>(a) * count_[1] + b) * count_[2] + c; }
  Vec3i place(std::size_t n) const;
  /// The brick that owns a cell or lattice point.
  std::size_t index_of(const Vec3i& cell) const {
    return index(cell.x / kBrickSide, cell.y / kBrickSide, cell.z / kBrickSide);
  }
  bool has(int a, int b, int c) const {
    return a >= 0 && b >= 0 && c >= 0 && a < count_[0] && b < count_[1] && c < count_[2];
  }

  /// Signs of a brick, also of one outside the lattice.
  const SignRows& signs(int a, int b, int c) const { return has(a, b, c) ? *bricks_[index(a, b, c)].signs : outside(); }
  /// Bricks without a surface share their signs.
  void set_signs(std::size_t n, const SignRows& rows);
  static const SignRows& outside();
  static const SignRows& inside();

  /// Null if no edge or cell of the brick has both signs.
  const ActiveBrick* active(int a, int b, int c) const {
    return has(a, b, c) ? bricks_[index(a, b, c)].active.get() : nullptr;
  }
  ActiveBrick* active(std::size_t n) { return bricks_[n].active.get(); }
  const ActiveBrick* active(std::size_t n) const { return bricks_[n].active.get(); }
  void set_active(std::size_t n, std::unique_ptr<ActiveBrick> brick) { bricks_[n].active = std::move(brick); }
  /// The active brick that owns a cell with both signs, or an edge that starts at such a point.
  ActiveBrick& owner(const Vec3i& cell) { return *bricks_[index_of(cell)].active; }

  /// Sign of a lattice point, also of one outside the lattice.
  bool at(int i, int j, int k) const {
    return signs(i >> 5, j >> 5, k >> 5)[(i & 31) * kBrickSide + (j & 31)] >> (k & 31) & 1;
  }
  /// Signs of the points (i, j, k) … (i, j, k + 31), the first in the lowest bit.
  std::uint64_t bits(int i, int j, int k) const {
    const int row = (i & 31) * kBrickSide + (j & 31), low = k & 31;
    const std::uint64_t here = signs(i >> 5, j >> 5, k >> 5)[row], above = signs(i >> 5, j >> 5, (k >> 5) + 1)[row];
    return (here | above << 32) >> low & 0xffffffff;
  }
  /// Number of the quad of a crossed edge.
  std::uint32_t quad_of(const LatticeEdge& edge) const;

 private:
  struct Brick {
    const SignRows* signs = &outside();
    std::unique_ptr<SignRows> own;
    std::unique_ptr<ActiveBrick> active;
  };
  std::array<int, 3> count_;
  std::vector<Brick> bricks_;
};

}  // namespace riffler::marching
