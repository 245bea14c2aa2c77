// Finds where the rays (columns) of a grid cross the triangles of a mesh. Decisions are exact, on a lattice, so a
// column enters a closed mesh as often as it leaves it, at any alignment.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "riffler/base/bulk.hpp"
#include "riffler/dexel/grid.hpp"
#include "riffler/mesh/mesh.hpp"

namespace riffler::dexel {

/// One signed crossing of a column in increasing order of z: +1 enters (the triangle faces down the ray), −1 leaves.
struct Crossing {
  double z;              ///< mm along the ray
  std::uint32_t source;  ///< index of the triangle, or kOpening | index of the opening
  std::int32_t sign;
};
inline constexpr std::uint32_t kOpening = 0x80000000U;

/// Crossings of a band of rows, with their columns, numbered (row − first row) · nv + column.
class BandCrossings {
 public:
  /// Bit positions of a crossing's sign and of its column, above its source.
  static constexpr std::int64_t kLeaves = std::int64_t{1} << 32;
  static constexpr int kColumnShift = 33;

  std::size_t size() const { return size_; }
  void clear() { size_ = 0; }
  void add(const Crossing& c, std::uint32_t column) {
    const auto [z, name] = room(1);
    *z = c.z, *name = (static_cast<std::int64_t>(column) << kColumnShift) | (c.sign < 0 ? kLeaves : 0) | c.source;
    added(1);
  }
  Crossing operator[](std::size_t k) const {
    return {z_[k], static_cast<std::uint32_t>(names_[k]), (names_[k] & kLeaves) != 0 ? -1 : 1};
  }
  std::uint32_t column(std::size_t k) const { return static_cast<std::uint32_t>(names_[k] >> kColumnShift); }

  /// Reserves room for `more` crossings and returns where to write them: their z, and their packed names.
  std::pair<double*, std::int64_t*> room(std::size_t more) {
    if (z_.size() < size_ + more) grow(more);
    return {z_.data() + size_, names_.data() + size_};
  }
  void added(std::size_t n) { size_ += n; }

 private:
  void grow(std::size_t more);

  base::BulkVector<double> z_;
  base::BulkVector<std::int64_t> names_;
  std::size_t size_ = 0;
};

/// A mesh in the cyclic frame of a grid, in units of cells: ray (i, j) is at the integers u = i, v = j. The u and v of
/// each vertex are rounded once, to multiples of 2^−30 (coarser only if the mesh is more than 2^20 cells wide);
/// rounding vertices keeps a watertight mesh watertight. z stays in mm, unrounded.
class Projection {
 public:
  struct Vertex {
    double u, v, z;
    std::int32_t row, column;  ///< ⌈u⌉ and ⌈v⌉, clamped to [0, nu] and [0, nv]
  };

  /// Throws std::invalid_argument if the mesh reaches more than 2^50 cells from the grid.
  Projection(const Mesh& mesh, const Grid& grid);

  int nu() const { return nu_; }
  int nv() const { return nv_; }
  double slack() const { return slack_; }
  const Vertex& vertex(int index) const { return vertices_[index]; }
  const base::BulkVector<Vertex>& vertices() const { return vertices_; }
  void prefetch(const Vec3i& corners) const {
    for (int k = 0; k < 3; ++k) __builtin_prefetch(&vertices_[corners[k]]);
  }

  /// ⌈v*⌉ clamped to [0, nv], where v* is the point at which the edge from `low` to `high` meets u = row, for low.row ≤
  /// row < high.row. Exact: the result depends on the edge and the row alone, not on the triangle. `v` approximates v*.
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

 private:
  /// v* > column, decided in integers.
  bool beyond(const Vertex& low, const Vertex& high, int row, int column) const;

  int nu_, nv_;
  double lattice_;  // lattice points per cell, a power of two
  double slack_;    // cells; exceeds the rounding error of an edge's v at a row
  base::BulkVector<Vertex> vertices_;
};

/// Triangles sorted into bands of rows. Each band lists the triangles that may cross its rows, in mesh order.
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
  base::BulkVector<std::uint32_t> triangles_;
};

/// Sorts the crossings of a band by column, then z, then source. `begin` has one entry more than there are columns.
void sort_by_column(const BandCrossings& crossings, std::size_t columns, std::vector<Crossing>& sorted,
                    std::vector<std::uint32_t>& begin);

}  // namespace riffler::dexel
