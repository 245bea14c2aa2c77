// Each dab has three stages: the ends of all spans in the brush become points of the surface (end_points.hpp), the
// points move (relax.hpp), and the rays are rebuilt from the moved points (moved_field.hpp, recut.hpp). One field
// defines all three grids, so they agree.
#include "riffler/dexel/smooth/smooth_dabs.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include "dexel/protected_tile.hpp"
#include "dexel/smooth/moved_field.hpp"
#include "dexel/smooth/recut.hpp"
#include "dexel/smooth/relax.hpp"
#include "riffler/base/check.hpp"
#include "riffler/base/parallel.hpp"
#include "riffler/dexel/boolean.hpp"

namespace riffler::dexel {

namespace {

using TilePtr = std::shared_ptr<const Tile>;

void check(const Volume& volume, std::span<const Vec3> centres, const SmoothOptions& options) {
  if (volume.frame().directions != "xyz")
    throw std::invalid_argument(
        "soften needs a volume of directions \"xyz\", whose ends have normals; this one has \"" +
        volume.frame().directions + "\"");
  for (std::size_t i = 0; i < centres.size(); ++i)
    if (!geom::finite(centres[i])) throw std::invalid_argument("centres, row " + std::to_string(i) + ": not finite");
  base::require_length(options.radius, "radius");
  if (!(options.strength >= 0 && options.strength <= 1)) throw std::invalid_argument("strength must be from 0 to 1");
  if (options.protect) check_same_grid(volume.frame(), options.protect->frame(), "protect");
}

/// A tile in which rays may change.
struct Touched {
  std::size_t grid, tile;
  TilePtr after;
  double removed = 0, added = 0;  // mm of rays
  Stats stats;
};

/// The tiles of all grids with rays within `radius` of the centre.
std::vector<Touched> touched_tiles(const Volume& volume, const Vec3& centre, double radius) {
  std::vector<Touched> out;
  for (std::size_t g = 0; g < volume.grids().size(); ++g) {
    const Grid& grid = volume.grids()[g];
    const Vec3 c = to_local(grid.axis(), centre);
    const auto [i0, i1] = ray_indices({c.x - radius, c.x + radius}, grid.box().lower.x, grid.pitch(), grid.nu());
    const auto [j0, j1] = ray_indices({c.y - radius, c.y + radius}, grid.box().lower.y, grid.pitch(), grid.nv());
    if (i0 > i1 || j0 > j1) continue;
    for (int a = i0 / kTileSide; a <= i1 / kTileSide; ++a)
      for (int b = j0 / kTileSide; b <= j1 / kTileSide; ++b) out.push_back({g, grid.tile_index(a, b), {}, 0, 0, {}});
  }
  return out;
}

class Dab {
 public:
  Dab(const Volume& volume, const Vec3& centre, const SmoothOptions& options, const Progress& progress)
      : volume_(volume), options_(options), pitch_(volume.frame().pitch), centre_(centre) {
    // Rays change no farther out than a gap between points plus a move, and the field there needs as much again.
    const double margin = 5 * pitch_;
    points_ = relax(end_points(volume, centre, options.radius + margin, options.protect), pitch_,
                    {centre, options.radius, options.strength}, progress);
    for (const MovedPoint& p : points_) moves_ = moves_ || p.moved();
    if (!moves_) return;
    std::vector<Vec3> places;
    places.reserve(points_.size());
    for (const MovedPoint& p : points_) places.push_back(p.after);
    for (const Grid& grid : volume.grids()) columns_.emplace_back(grid.axis(), places, pitch_);
  }

  bool moves() const { return moves_; }

  void run(Touched& t) const {
    const Grid& grid = volume_.grids()[t.grid];
    const TilePtr& before = grid.shared_tile(t.tile);
    MovedField field(points_, columns_[t.grid], pitch_);
    Recutter recutter(grid, field);
    t.after = recutter.run(t.tile, centre_, options_.radius + 3 * pitch_, t.stats);
    if (t.after == before) return;
    if (options_.protect)
      t.after = with_protected(grid, t.tile, before, t.after, options_.protect->grids()[t.grid].shared_tile(t.tile));
    if (t.after == before) return;
    for (int r = 0; r < kTileRays && &grid == &volume_.reference(); ++r) {
      t.removed += length_without(before->ray(r), t.after->ray(r));
      t.added += length_without(t.after->ray(r), before->ray(r));
    }
  }

 private:
  const Volume& volume_;
  const SmoothOptions& options_;
  double pitch_;
  Vec3 centre_;
  bool moves_ = false;
  std::vector<MovedPoint> points_;
  std::vector<Columns> columns_;
};

/// Applies one dab and adds the removed and added volumes, mm³. Returns whether anything changed.
bool apply_dab(Volume& volume, const Vec3& centre, const SmoothOptions& options, const Progress& progress,
               double& removed, double& added) {
  Stats stats;
  stats.moves = 1;
  const Dab dab(volume, centre, options, base::part(progress, 0, 0.3));
  std::vector<Touched> tiles;
  if (dab.moves()) tiles = touched_tiles(volume, centre, options.radius + 3 * volume.frame().pitch);
  constexpr std::size_t grain = 1;
  base::parallel_for(
      tiles.size(), grain,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) dab.run(tiles[k]);
      },
      base::part(progress, 0.3, 1));
  const double area = volume.frame().pitch * volume.frame().pitch;
  for (const Touched& t : tiles) {
    stats += t.stats;
    Grid& grid = volume.grids()[t.grid];
    if (t.after == grid.shared_tile(t.tile)) continue;
    grid.set_tile(t.tile, t.after);
    removed += t.removed * area, added += t.added * area;
    ++stats.tiles_changed, stats.bytes_copied += t.after->nbytes();
  }
  stats.tiles_visited = tiles.size();
  volume.count(stats);
  return stats.tiles_changed > 0;
}

}  // namespace

SmoothResult smooth_dabs(Volume& volume, std::span<const Vec3> centres, const SmoothOptions& options) {
  check(volume, centres, options);
  SmoothResult out{std::vector<double>(centres.size()), std::vector<double>(centres.size())};
  if (options.strength == 0) return out;
  Volume work = volume;
  bool changed = false;
  for (std::size_t k = 0; k < centres.size(); ++k) {
    const double n = static_cast<double>(centres.size()), done = static_cast<double>(k);
    const Progress share = base::part(options.progress, done / n, (done + 1) / n);
    changed |= apply_dab(work, centres[k], options, share, out.removed[k], out.added[k]);
    base::report(options.progress, (done + 1) / n);
  }
  if (changed) work.touch();
  volume = std::move(work);
  return out;
}

}  // namespace riffler::dexel
