#include "sweep/tile_versions.hpp"

#include <cstring>

namespace riffler::sweep {

namespace {

/// Compares bits, not values: −0 and 0 differ in a file.
bool same_spans(const base::BlockVector<dexel::Span>& a, const base::BlockVector<dexel::Span>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0);
}

}  // namespace

bool same_bytes(const dexel::Tile& a, const dexel::Tile& b) {
  return &a == &b || (same_spans(a.spans, b.spans) && a.offset == b.offset && a.normals == b.normals);
}

void thin(TileVersions& versions, std::size_t stride) noexcept {
  const dexel::Tile* kept = nullptr;
  std::size_t since = 0;  // strokes since the version kept last, or since the base
  for (std::size_t k = 0; k + 1 < versions.size(); ++k) {
    ++since;
    auto& tile = versions[k].tile;
    if (!tile || tile.get() == kept) continue;
    if (since >= stride || tile == versions.back().tile)
      kept = tile.get(), since = 0;
    else
      tile.reset();
  }
}

VersionCost cost_of(const TileVersions& versions, const dexel::Tile* base, std::size_t from) {
  VersionCost cost;
  const dexel::Tile* last = base;
  for (std::size_t k = from; k > 0 && last == base; --k)
    if (versions[k - 1].tile) last = versions[k - 1].tile.get();
  for (std::size_t k = from; k < versions.size(); ++k) {
    const TileVersion& v = versions[k];
    if (!v.tile || v.tile.get() == last || v.tile.get() == base) continue;
    last = v.tile.get();
    ++cost.count, cost.bytes += last->nbytes();
  }
  return cost;
}

}  // namespace riffler::sweep
