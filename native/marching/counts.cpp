#include "marching/counts.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "geom/parallel.hpp"

namespace riffler::marching {

namespace {

/// Running sum: element n becomes the sum of those before it.
std::size_t accumulate_before(std::vector<std::size_t>& counts) {
  std::size_t sum = 0;
  for (std::size_t& c : counts) sum += std::exchange(c, sum);
  return sum;
}

}  // namespace

Counts::Counts(const Lattice& lattice, const SignField& signs, const Progress& progress)
    : columns_(lattice.cells(1)), plane_edge_(lattice.cells(0) + 1), plane_vertex_(lattice.cells(0) + 1) {
  column_.resize(offset(lattice.cells(0), 0));
  const CaseTable& table = case_table();
  parallel_for(
      static_cast<std::size_t>(lattice.cells(0)), 8,
      [&](std::size_t begin, std::size_t end) {
        for (int i = static_cast<int>(begin); i < static_cast<int>(end); ++i) {
          std::uint32_t edges = 0;
          std::size_t vertices = 0;
          for (int j = 0; j < columns_; ++j) {
            for (int axis = 0; axis < 3; ++axis) {
              column_[offset(i, j)][axis] = edges;
              for (int w = 0; w < signs.words(); ++w)
                if (const std::uint64_t word = crossed_edges(signs, i, j, axis, w))
                  edges += static_cast<std::uint32_t>(std::popcount(word));
            }
            visit_cells(signs, i, j,
                        [&](int k, int code) { vertices += entry_of(table, signs, i, j, k, code).cycles; });
          }
          plane_edge_[i] = edges, plane_vertex_[i] = vertices;
        }
      },
      progress);
  if (accumulate_before(plane_edge_) > std::numeric_limits<std::int32_t>::max() / 2 ||
      accumulate_before(plane_vertex_) > std::numeric_limits<std::int32_t>::max())
    throw std::invalid_argument("the mesh of this volume would have more than 2^31 triangles; take a coarser pitch");
}

LatticeEdge Counts::locate(const SignField& signs, std::size_t edge) const {
  const auto plane = std::upper_bound(plane_edge_.begin(), plane_edge_.end(), edge) - 1;
  const int i = static_cast<int>(plane - plane_edge_.begin());
  const auto rest = static_cast<std::uint32_t>(edge - *plane);
  const auto row = column_.begin() + static_cast<std::ptrdiff_t>(offset(i, 0));
  const auto column =
      std::upper_bound(row, row + columns_, rest, [](std::uint32_t n, const auto& starts) { return n < starts[0]; }) -
      1;
  const int j = static_cast<int>(column - row);
  int axis = 2;
  while (axis > 0 && (*column)[axis] > rest) --axis;
  std::uint32_t skip = rest - (*column)[axis];
  for (int w = 0;; ++w) {
    std::uint64_t word = crossed_edges(signs, i, j, axis, w);
    const auto count = static_cast<std::uint32_t>(std::popcount(word));
    if (skip >= count) {
      skip -= count;
      continue;
    }
    for (; skip; --skip) word &= word - 1;
    const int k = 64 * w + std::countr_zero(word);
    return {axis, i, j, k, !signs.at(i, j, k)};
  }
}

}  // namespace riffler::marching
