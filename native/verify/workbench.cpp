#include "verify/workbench.hpp"

#include <algorithm>

namespace riffler::verify {

namespace {

/// A grid with the same rays and no material.
dexel::Grid emptied(const dexel::Grid& like) {
  return {like.axis(),
          {to_world(like.axis(), like.box().lower), to_world(like.axis(), like.box().upper)},
          like.pitch(),
          like.has_normals()};
}

}  // namespace

Workbench::Workbench(const dexel::Grid& like, const Slab& slab, double tolerance)
    : grid_(emptied(like)), slab_(slab), nothing_(tiles_of(grid_, slab)), tolerance_(tolerance) {}

std::vector<double> Workbench::cut(SlabTiles& tiles, std::span<const sweep::ConvexGroup> cutter,
                                   std::span<const Pose> poses, std::span<const std::uint32_t> ends) {
  put_tiles(grid_, slab_, tiles);
  std::vector<double> taken = carve_moves(grid_, cutter, poses, ends, tolerance_, stats_);
  tiles = tiles_of(grid_, slab_);
  put_tiles(grid_, slab_, nothing_);
  return taken;
}

bool Workbench::touches(const SlabTiles& tiles, std::span<const sweep::ConvexGroup> shape, std::span<const Pose> poses,
                        std::span<const std::uint32_t> ends) {
  const auto takes = [&](const SlabTiles& from) {
    SlabTiles copy = from;
    cut(copy, shape, poses, ends);
    const auto changed = std::mismatch(copy.begin(), copy.end(), from.begin());
    if (changed.first == copy.end()) return false;
    hint_ = static_cast<std::size_t>(changed.first - copy.begin());
    return true;
  };
  SlabTiles one = nothing_;
  one[hint_] = tiles[hint_];
  if (!one[hint_]->spans.empty() && takes(one)) return true;
  return takes(tiles);
}

SlabTiles Workbench::after(const SlabTiles& tiles, std::span<const sweep::ConvexGroup> shape, const Pose& from,
                           const Pose& to) {
  SlabTiles copy = tiles;
  const Pose poses[] = {from, to};
  const std::uint32_t end = 1;
  cut(copy, shape, poses, {&end, 1});
  return copy;
}

}  // namespace riffler::verify
