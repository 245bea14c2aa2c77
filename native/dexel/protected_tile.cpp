#include "dexel/protected_tile.hpp"

#include <algorithm>

#include "riffler/dexel/boolean.hpp"

namespace riffler::dexel {

std::shared_ptr<const Tile> with_protected(const Grid& grid, std::size_t tile,
                                           const std::shared_ptr<const Tile>& before,
                                           const std::shared_ptr<const Tile>& after,
                                           const std::shared_ptr<const Tile>& kept) {
  using TilePtr = std::shared_ptr<const Tile>;
  TileBuilder builder(true);
  const auto op = [&](Boolean o, const TilePtr& a, const TilePtr& b) { return apply(o, grid, tile, a, b, builder); };
  const TilePtr lost = op(Boolean::Subtract, op(Boolean::Subtract, before, after), kept);
  const TilePtr won = op(Boolean::Subtract, op(Boolean::Subtract, after, before), kept);
  return op(Boolean::Add, op(Boolean::Subtract, before, lost), won);
}

double length_without(std::span<const Span> a, std::span<const Span> b) {
  double sum = 0;
  auto other = b.begin();
  for (const Span& s : a) {
    double from = s.near;
    while (other != b.end() && other->far <= from) ++other;
    for (auto k = other; k != b.end() && k->near < s.far; ++k) {
      sum += std::max(0.0, k->near - from);
      from = std::max(from, k->far);
    }
    sum += std::max(0.0, s.far - from);
  }
  return sum;
}

}  // namespace riffler::dexel
