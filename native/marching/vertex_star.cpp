#include "marching/vertex_star.hpp"

#include <algorithm>
#include <bit>

#include "base/sort_unique.hpp"

namespace riffler::marching {

namespace {

/// The cells of a column that may have a vertex. A cell has a vertex for each sheet of surface in it, at least one if
/// its corners differ, so the cells of most columns are known exactly by the vertex's place in the column.
struct ColumnCells {
  int i, j;            // the column, in the brick
  std::uint32_t bits;  // K of the cells
};

/// Signs of the points (i, j, k) … (i, j, k + 32).
std::uint64_t signs_of(const Bricks& bricks, int i, int j, int k) {
  return bricks.bits(i, j, k) | static_cast<std::uint64_t>(bricks.at(i, j, k + kBrickSide)) << kBrickSide;
}

ColumnCells cells_of(const Bricks& bricks, const ActiveBrick& brick, std::int32_t vertex) {
  const std::size_t in_brick = static_cast<std::size_t>(vertex) - brick.first_vertex;
  const auto plane = std::upper_bound(brick.plane_vertex.begin(), brick.plane_vertex.end() - 1, in_brick) - 1;
  const auto i = static_cast<int>(plane - brick.plane_vertex.begin());
  const std::size_t in_plane = in_brick - *plane;
  const auto first = brick.column_vertex.begin() + i * kBrickSide;
  const auto column = std::upper_bound(first, first + kBrickSide, in_plane) - 1;
  const auto j = static_cast<int>(column - first);
  const Vec3i from = kBrickSide * brick.at;
  const std::uint64_t a = signs_of(bricks, from.x + i, from.y + j, from.z),
                      b = signs_of(bricks, from.x + i + 1, from.y + j, from.z),
                      c = signs_of(bricks, from.x + i, from.y + j + 1, from.z),
                      d = signs_of(bricks, from.x + i + 1, from.y + j + 1, from.z);
  const std::uint64_t any = a | b | c | d, all = a & b & c & d;
  auto mixed = static_cast<std::uint32_t>((any | any >> 1) & ~(all & all >> 1));
  const auto at = static_cast<int>(in_plane - *column), cells = std::popcount(mixed),
             more = static_cast<int>(brick.vertex_after(i, j) - brick.vertex(i, j)) - cells;
  for (int n = 0; n < at - more; ++n) mixed &= mixed - 1;                // the cells before it
  for (int n = at + 1; n < cells; ++n) mixed &= ~std::bit_floor(mixed);  // and after it
  return {i, j, mixed};
}

}  // namespace

const std::vector<std::size_t>& VertexStar::of(const ActiveBrick& brick, std::int32_t vertex) {
  const ColumnCells column = cells_of(surface_.bricks, brick, vertex);
  const Vec3i from = kBrickSide * brick.at;
  quads_.clear(), triangles_.clear();
  for (std::uint32_t left = column.bits; left; left &= left - 1)
    append_quads(surface_, from + Vec3i(column.i, column.j, std::countr_zero(left)), kAnyMark, quads_);
  for (const QuadRef& ref : quads_)
    for (const std::size_t t : {2 * std::size_t{ref.quad}, 2 * std::size_t{ref.quad} + 1}) {
      const Vec3i& corner = surface_.mesh.triangles[t];
      if (corner.x == vertex || corner.y == vertex || corner.z == vertex) triangles_.push_back(t);
    }
  base::sort_unique(triangles_);
  return triangles_;
}

void for_upper_vertices(const Surface& surface, const ActiveBrick& brick,
                        const std::function<void(std::int32_t)>& body) {
  constexpr int kLast = kBrickSide - 1;
  const ActiveBrick* const above = surface.bricks.active(brick.at.x, brick.at.y, brick.at.z + 1);
  const auto all = [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) body(static_cast<std::int32_t>(v));
  };
  for (int i = 0; i < kLast; ++i) {
    for (int j = 0; j < kLast && above && above->edges() > 0; ++j)
      for (std::size_t v = brick.vertex_after(i, j); v > brick.vertex(i, j); --v) {
        const auto vertex = static_cast<std::int32_t>(v - 1);
        if (cells_of(surface.bricks, brick, vertex).bits >> kLast == 0) break;
        body(vertex);
      }
    all(brick.vertex(i, kLast), brick.vertex_after(i, kLast));
  }
  all(brick.first_vertex + brick.plane_vertex[kLast], brick.first_vertex + brick.plane_vertex[kBrickSide]);
}

}  // namespace riffler::marching
