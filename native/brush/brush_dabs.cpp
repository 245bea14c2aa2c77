// Each dab has four stages: the cells around it are cut out and meshed (patch.hpp), the mesh's vertices are displaced
// (displacement.hpp), the rays of all directions are intersected with the mesh before and after (crossings.hpp), and
// their ends move by the difference (rebuild.hpp).
#include "riffler/brush/brush_dabs.hpp"

#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "brush/rebuild.hpp"
#include "dexel/protected_tile.hpp"
#include "riffler/base/check.hpp"
#include "riffler/base/parallel.hpp"
#include "riffler/dexel/boolean.hpp"

namespace riffler::brush {

namespace {

/// Cells around the reach that belong to the patch: its cut faces are no part of the surface.
constexpr double kMargin = 4;

void check(const Volume& volume, std::span<const Pose> dabs, const BrushOptions& options) {
  if (volume.frame().directions != "xyz")
    throw std::invalid_argument("brush needs a volume of directions \"xyz\", whose ends have normals; this one has \"" +
                                volume.frame().directions + "\"");
  for (std::size_t i = 0; i < dabs.size(); ++i) {
    const std::string row = "dabs, row " + std::to_string(i) + ": ";
    if (!geom::finite(dabs[i].tip) || !geom::finite(dabs[i].axis)) throw std::invalid_argument(row + "not finite");
    if (!(std::abs(glm::length(dabs[i].axis) - 1) < 1e-6))
      throw std::invalid_argument(row + "the axis must be a unit vector");
  }
  base::require_length(options.radius, "radius");
  if (!(options.strength >= 0 && options.strength <= 1)) throw std::invalid_argument("strength must be from 0 to 1");
  base::require_finite(options.amount, "amount");
  if (options.protect) check_same_grid(volume.frame(), options.protect->frame(), "protect");
}

/// A dab's centre in a crop's frame, and how far it moves.
Reach in_crop(const Reach& reach, const Crop& crop) {
  return {reach.centre - crop.origin, reach.pull, reach.radius};
}

/// A tile in which rays may change.
struct Touched {
  std::size_t grid, tile;
  Rebuild::Result result;
  double removed = 0, added = 0;  // mm³
};

class Dab {
 public:
  Dab(const Volume& volume, const Reach& reach, const Vec3& axis, const BrushOptions& options) : volume_(volume) {
    crop_ = crop(volume, reach.box().grown(kMargin * volume.frame().pitch));
    if (!crop_) return;
    patch_.emplace(crop_->volume);
    displacement_.emplace(options, in_crop(reach, *crop_), axis);
    if (patch_->triangles().empty() || !patch_->displace(*displacement_)) return;
    rebuilds_.resize(volume.grids().size());
    constexpr std::size_t grain = 1;
    base::parallel_for(rebuilds_.size(), grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t g = begin; g < end; ++g)
        rebuilds_[g].emplace(volume.grids()[g], *crop_, *patch_, *displacement_);
    });
  }

  std::vector<Touched> tiles() const {
    std::vector<Touched> out;
    for (std::size_t g = 0; g < rebuilds_.size(); ++g)
      for (const std::size_t tile : rebuilds_[g]->tiles()) out.push_back({g, tile, {}});
    return out;
  }

  void run(Touched& t, const Volume* protect) const {
    const Grid& grid = volume_.grids()[t.grid];
    const auto& before = grid.shared_tile(t.tile);
    t.result = rebuilds_[t.grid]->run(t.tile);
    auto& after = t.result.tile;
    if (after == before) return;
    if (protect)
      after = dexel::with_protected(grid, t.tile, before, after, protect->grids()[t.grid].shared_tile(t.tile));
    if (after == before || &grid != &volume_.reference()) return;
    const int i0 = static_cast<int>(t.tile) / grid.tiles_v() * dexel::kTileSide;
    const int j0 = static_cast<int>(t.tile) % grid.tiles_v() * dexel::kTileSide;
    for (int r = 0; r < dexel::kTileRays; ++r) {
      const int i = i0 + r / dexel::kTileSide, j = j0 + r % dexel::kTileSide;
      if (i >= grid.nu() || j >= grid.nv()) continue;
      t.removed += grid.area(i, j) * dexel::length_without(before->ray(r), after->ray(r));
      t.added += grid.area(i, j) * dexel::length_without(after->ray(r), before->ray(r));
    }
  }

 private:
  using Grid = dexel::Grid;

  const Volume& volume_;
  std::optional<Crop> crop_;
  std::optional<Patch> patch_;
  std::optional<Displacement> displacement_;
  std::vector<std::optional<Rebuild>> rebuilds_;
};

/// Applies one dab and adds up its effect. Returns whether anything changed.
bool apply_dab(Volume& volume, const Reach& reach, const Vec3& axis, const BrushOptions& options, BrushResult& sum) {
  const Dab dab(volume, reach, axis, options);
  std::vector<Touched> tiles = dab.tiles();
  constexpr std::size_t grain = 1;
  base::parallel_for(tiles.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) dab.run(tiles[k], options.protect);
  });
  dexel::Stats stats;
  stats.moves = 1, stats.tiles_visited = tiles.size();
  double lost[3] = {};
  for (const Touched& t : tiles) {
    stats += t.result.stats;
    lost[t.grid] += t.result.lost;
    sum.clipped = sum.clipped || t.result.clipped;
    dexel::Grid& grid = volume.grids()[t.grid];
    if (t.result.tile == grid.shared_tile(t.tile)) continue;
    grid.set_tile(t.tile, t.result.tile);
    sum.removed += t.removed, sum.added += t.added;
    ++stats.tiles_changed, stats.bytes_copied += t.result.tile->nbytes();
  }
  sum.lost += std::max({lost[0], lost[1], lost[2]});  // a wall shows best to the rays that are square to it
  volume.count(stats);
  return stats.tiles_changed > 0;
}

/// The reach of dab `k`. Grab is one displacement, from the first dab to the last.
Reach reach_of(std::span<const Pose> dabs, std::size_t k, const BrushOptions& options) {
  Reach out{dabs[k].tip, Vec3(0), options.radius};
  if (options.kind == Kind::Grab) out.pull = dabs.back().tip - dabs[0].tip;
  if (options.kind == Kind::SnakeHook) out.pull = dabs[k + 1].tip - dabs[k].tip;
  return out;
}

std::size_t count_of(std::size_t dabs, Kind kind) {
  if (dabs == 0 || kind == Kind::Grab) return std::min<std::size_t>(dabs, 1);
  return kind == Kind::SnakeHook ? dabs - 1 : dabs;
}

}  // namespace

BrushResult brush_dabs(Volume& volume, std::span<const Pose> dabs, const BrushOptions& options) {
  check(volume, dabs, options);
  BrushResult out;
  if (options.strength == 0) return out;
  const std::size_t count = count_of(dabs.size(), options.kind);
  Volume work = volume;
  bool changed = false;
  for (std::size_t k = 0; k < count; ++k) {
    changed |= apply_dab(work, reach_of(dabs, k, options), dabs[k].axis, options, out);
    base::report(options.progress, static_cast<double>(k + 1) / static_cast<double>(count));
  }
  if (changed) work.touch();
  volume = std::move(work);
  return out;
}

}  // namespace riffler::brush
