// Where the columns of a grid cross the triangles of a mesh: exact decisions on a lattice, so that a closed mesh is
// entered as often as it is left on every column, at any alignment.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "dexel/grid.hpp"
#include "mesh/mesh.hpp"

namespace riffler {

/// One signed crossing of a column, by rising coordinate: +1 enters (the triangle faces down the ray), −1 leaves.
struct Crossing {
  double z;              ///< mm along the ray
  std::uint32_t source;  ///< index of the triangle, or kOpening | index of the opening
  std::int32_t sign;
};
inline constexpr std::uint32_t kOpening = 0x80000000U;

/// A crossing and the column of a band that it belongs to.
struct BandCrossing {
  Crossing crossing;
  std::uint32_t column;  ///< (row − first row) · nv + column
};

/// A mesh in the cyclic frame of a grid, in cells: ray (i, j) stands at the integers u = i, v = j. u and v are rounded
/// to multiples of 2^−30 (fewer bits only where the mesh is more than 2^20 cells wide), once for each vertex; a mesh
/// whose vertices are so rounded is as watertight as it was. z stays in mm, unrounded.
class Projection {
 public:
  struct Vertex {
    double u, v, z;
    std::int32_t row, column;  ///< ⌈u⌉ and ⌈v⌉, clamped to [0, nu] and [0, nv]
  };

  /// Throws std::invalid_argument where the mesh reaches more than 2^50 cells from the grid.
  Projection(const Mesh& mesh, const Grid& grid);

  int nu() const { return nu_; }
  int nv() const { return nv_; }
  const Vertex& vertex(int index) const { return vertices_[index]; }
  const std::vector<Vertex>& vertices() const { return vertices_; }
  void prefetch(const Vec3i& corners) const {
    for (int k = 0; k < 3; ++k) __builtin_prefetch(&vertices_[corners[k]]);
  }

  /// ⌈v*⌉ clamped to [0, nv], where v* is the point at which the edge from `low` to `high` meets u = row, for
  /// low.row ≤ row < high.row. Exact: it depends on the edge and the row alone, not on the triangle. `v` is near v*.
  int column(const Vertex& low, const Vertex& high, int row, double v) const {
    if (!(v > -0.5)) return 0;
    if (v > nv_ + 0.5) return nv_;
    int ceiling = static_cast<int>(v + 1);  // unless v is an integer
    const double past = v + 1 - ceiling;
    if (past < slack_)
      ceiling -= !beyond(low, high, row, ceiling - 1);
    else if (past > 1 - slack_)
      ceiling += beyond(low, high, row, ceiling);
    return std::clamp(ceiling, 0, nv_);
  }

  /// Appends the crossings of one triangle with rows first ≤ row < last.
  void cross(const Vec3i& corners, std::uint32_t triangle, int first, int last, std::vector<BandCrossing>& out) const;

 private:
  /// v* > column, in integers.
  bool beyond(const Vertex& low, const Vertex& high, int row, int column) const;

  int nu_, nv_;
  double lattice_;  // lattice points per cell, a power of two
  double slack_;    // more than the rounding error of an edge's v at a row, cells
  std::vector<Vertex> vertices_;
};

/// Triangles by bands of rows: those that may cross a column with a row in band k, in the order of the mesh.
class Bands {
 public:
  Bands(const Mesh& mesh, const Projection& projection, int rows_per_band);

  int rows() const { return rows_; }
  std::span<const std::uint32_t> band(int k) const {
    return {triangles_.data() + begin_[k], triangles_.data() + begin_[k + 1]};
  }
  std::size_t size() const { return triangles_.size(); }

 private:
  int rows_;
  std::vector<std::size_t> begin_;
  std::vector<std::uint32_t> triangles_;
};

/// Crossings of a band sorted by column and, within one, by z (stable). `begin` has one entry more than there are
/// columns.
void sort_by_column(const std::vector<BandCrossing>& crossings, std::size_t columns, std::vector<Crossing>& sorted,
                    std::vector<std::uint32_t>& begin);

}  // namespace riffler
