#include <bit>

#include "marching/neighbourhood.hpp"
#include "marching/surface.hpp"

namespace riffler::marching {

namespace {

/// Whether a brick and those that share its upper points all lie on the same side.
bool uniform(const Bricks& bricks, const Vec3i& b) {
  const SignRows* const here = &bricks.signs(b.x, b.y, b.z);
  if (here != &Bricks::inside() && here != &Bricks::outside()) return false;
  for (int n = 1; n < 8; ++n)
    if (&bricks.signs(b.x + (n & 1), b.y + (n >> 1 & 1), b.z + (n >> 2)) != here) return false;
  return true;
}

}  // namespace

std::unique_ptr<ActiveBrick> counted(const Bricks& bricks, std::size_t n) {
  const Vec3i at = bricks.place(n);
  if (uniform(bricks, at)) return nullptr;
  constexpr std::uint64_t own = Neighbourhood::kOwn;
  const CaseTable& table = case_table();
  const Neighbourhood signs(bricks, at);
  auto brick = std::make_unique<ActiveBrick>();
  brick->at = at;
  std::uint32_t edges = 0, vertices = 0;
  for (int i = 0; i < kBrickSide; ++i) {
    const std::uint32_t edges_before = brick->plane_edge[i] = edges;
    const std::uint32_t vertices_before = brick->plane_vertex[i] = vertices;
    for (int j = 0; j < kBrickSide; ++j) {
      const int column = i * kBrickSide + j;
      brick->column_edge[column] = static_cast<std::uint16_t>(edges - edges_before);
      brick->column_vertex[column] = static_cast<std::uint16_t>(vertices - vertices_before);
      std::uint64_t mixed = signs.mixed(i, j) & own;
      if (mixed == 0) continue;
      for (int axis = 0; axis < 3; ++axis)
        edges += static_cast<std::uint32_t>(std::popcount(signs.crossed(axis, i, j) & own));
      for (; mixed; mixed &= mixed - 1)
        vertices += signs.entry(table, i, j, std::countr_zero(mixed) - Neighbourhood::kLayers).cycles;
    }
  }
  brick->plane_edge[kBrickSide] = edges, brick->plane_vertex[kBrickSide] = vertices;
  if (edges == 0 && vertices == 0) return nullptr;
  return brick;
}

}  // namespace riffler::marching
