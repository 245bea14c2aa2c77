#include <algorithm>
#include <bit>

#include "base/sort_unique.hpp"
#include "marching/surface.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::marching {

Quad Surface::quad(const QuadRef& ref) const {
  Quad out{{}, ref.edge.axis, ref.edge.rising ? -1.0 : 1.0};
  const auto corner = corners(ref.quad);
  for (int c = 0; c < 4; ++c) out.corner[c] = mesh.vertices[corner[c]];
  return out;
}

bool Surface::split(const QuadRef& ref, HitFinder& finder) {
  const int diagonal = choose_diagonal(quad(ref), place_of(ref.edge, finder(ref.edge)), diagonal_tie(lattice));
  write(ref.quad, corners(ref.quad), diagonal);
  return diagonal >= 0;
}

VertexChoice& Surface::special(const CellVertex& v) {
  std::vector<VertexChoice>& all = bricks.owner(v.cell).specials;
  return *std::lower_bound(all.begin(), all.end(), v,
                           [](const VertexChoice& s, const CellVertex& w) { return s.at < w; });
}

void append_quads(const Surface& surface, const Vec3i& cell, std::uint8_t mark, std::vector<QuadRef>& out) {
  const Bricks& bricks = surface.bricks;
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = cell.x; i <= cell.x + (axis != 0); ++i)
      for (int j = cell.y; j <= cell.y + (axis != 1); ++j) {
        const std::uint64_t here = bricks.bits(i, j, cell.z);
        std::uint64_t crossed = here ^ (axis == 2 ? here >> 1 : bricks.bits(i + (axis == 0), j + (axis == 1), cell.z));
        for (crossed &= axis == 2 ? 1 : 3; crossed; crossed &= crossed - 1) {
          const int b = std::countr_zero(crossed);
          const LatticeEdge edge{axis, i, j, cell.z + b, !(here >> b & 1)};
          const std::uint32_t quad = bricks.quad_of(edge);
          const auto c = surface.corners(quad);
          const base::BulkVector<std::uint8_t>& m = surface.marks;
          if (mark == kAnyMark || (m[c[0]] | m[c[1]] | m[c[2]] | m[c[3]]) & mark) out.push_back({quad, edge});
        }
      }
  }
}

std::vector<QuadRef> quads_near(const Surface& surface, const std::vector<Vec3i>& cells, std::uint8_t mark) {
  constexpr std::size_t chunk = 1024;
  std::vector<std::vector<QuadRef>> parts((cells.size() + chunk - 1) / chunk);
  base::parallel_for(cells.size(), chunk, [&](std::size_t begin, std::size_t end) {
    std::vector<QuadRef>& found = parts[begin / chunk];
    for (std::size_t n = begin; n < end; ++n) append_quads(surface, cells[n], mark, found);
    base::sort_unique(found);
  });
  std::vector<QuadRef> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  if (parts.size() > 1) base::sort_unique(all);
  return all;
}

}  // namespace riffler::marching
