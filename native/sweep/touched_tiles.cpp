#include "sweep/touched_tiles.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "riffler/base/parallel.hpp"
#include "sweep/hull_steps.hpp"
#include "sweep/steps.hpp"

namespace riffler::sweep {

namespace {

/// Pitches by which a footprint is widened, so that rounding never loses a tile.
constexpr double kSlack = 1e-9;

/// A tile and moves that touch it.
struct TileRun {
  std::uint32_t tile;
  MoveRun run;
};

/// Calls visit(tile) for the tiles with rays under a footprint.
template <class Visit>
void each_tile_under(const dexel::Grid& grid, const Footprint& footprint, const Visit& visit) {
  const TileBlock under = tiles_under(grid, footprint);
  if (under.empty()) return;
  const double h = grid.pitch(), slack = kSlack * h;
  const Vec3& lower = grid.box().lower;
  const auto [u0, u1] = dexel::ray_indices(footprint.rows(), lower.x, h, grid.nu());
  for (int a = under.row; a <= under.last_row; ++a) {
    const int first = std::max(u0, a * dexel::kTileSide), last = std::min(u1, (a + 1) * dexel::kTileSide - 1);
    double u[dexel::kTileSide];
    for (int i = first; i <= last; ++i) u[i - first] = grid.shifted_u(i);
    Footprint::Rows rows;
    footprint.rows(u, last - first + 1, rows);
    int low = grid.nv(), high = -1;
    for (int k = 0; k <= last - first; ++k) {
      const auto [j0, j1] = dexel::ray_indices({rows.near[k] - slack, rows.far[k] + slack}, lower.y, h, grid.nv());
      if (j0 <= j1) low = std::min(low, j0), high = std::max(high, j1);
    }
    for (int b = low / dexel::kTileSide; high >= 0 && b <= high / dexel::kTileSide; ++b) visit(grid.tile_index(a, b));
  }
}

/// Joins neighbouring runs of sorted entries.
void join(std::vector<TileRun>& runs) {
  std::size_t n = 0;
  for (const TileRun& r : runs) {
    if (n > 0 && runs[n - 1].tile == r.tile && runs[n - 1].run.end >= r.run.first)
      runs[n - 1].run.end = std::max(runs[n - 1].run.end, r.run.end);
    else
      runs[n++] = r;
  }
  runs.resize(n);
}

/// The tiles that moves first … end − 1 touch, sorted by tile, then by move.
template <class Body, class AnyPose>
std::vector<TileRun> runs_of(const dexel::Grid& grid, std::span<const Body> cutter, std::span<const AnyPose> poses,
                             double tolerance, MoveRun moves) {
  using AnyMotion = std::conditional_t<std::is_same_v<AnyPose, Pose>, Motion, RolledMotion>;
  std::vector<TileRun> out;
  for (std::uint32_t m = moves.first; m < moves.end; ++m) {
    const AnyMotion motion(to_local(grid.axis(), poses[m]), to_local(grid.axis(), poses[m + 1]));
    for_each_step(cutter, motion, m, grid.box(), tolerance, [&](Step&& step) {
      each_tile_under(grid, step.footprint,
                      [&](std::size_t tile) { out.push_back({static_cast<std::uint32_t>(tile), {m, m + 1}}); });
    });
  }
  std::ranges::stable_sort(out, {}, &TileRun::tile);
  join(out);
  return out;
}

template <class Body, class AnyPose>
TouchedTiles touched_by(const dexel::Grid& grid, std::span<const Body> cutter, std::span<const AnyPose> poses,
                        double tolerance, const Progress& progress) {
  constexpr std::size_t kChunk = 64;  // moves
  const std::size_t moves = poses.empty() ? 0 : poses.size() - 1;
  std::vector<std::vector<TileRun>> chunks((moves + kChunk - 1) / kChunk);
  base::parallel_for(
      chunks.size(), 1,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k)
          chunks[k] = runs_of(
              grid, cutter, poses, tolerance,
              {static_cast<std::uint32_t>(k * kChunk), static_cast<std::uint32_t>(std::min(moves, (k + 1) * kChunk))});
      },
      progress);
  std::vector<TileRun> all;
  for (const auto& chunk : chunks) all.insert(all.end(), chunk.begin(), chunk.end());
  std::ranges::stable_sort(all, {}, &TileRun::tile);
  join(all);
  TouchedTiles out;
  out.runs.reserve(all.size());
  for (const TileRun& r : all) {
    if (out.tiles.empty() || out.tiles.back() != r.tile)
      out.tiles.push_back(r.tile), out.begin.push_back(static_cast<std::uint32_t>(out.runs.size()));
    out.runs.push_back(r.run);
  }
  out.begin.push_back(static_cast<std::uint32_t>(out.runs.size()));
  return out;
}

}  // namespace

std::size_t TouchedTiles::index(std::size_t tile) const {
  return static_cast<std::size_t>(std::ranges::lower_bound(tiles, tile) - tiles.begin());
}

std::size_t TouchedTiles::nbytes() const {
  return tiles.capacity() * sizeof tiles[0] + begin.capacity() * sizeof begin[0] + runs.capacity() * sizeof runs[0];
}

TouchedTiles touched_tiles(const dexel::Grid& grid, std::span<const ConvexGroup> cutter, std::span<const Pose> poses,
                           double tolerance, const Progress& progress) {
  return touched_by(grid, cutter, poses, tolerance, progress);
}

TouchedTiles touched_tiles(const dexel::Grid& grid, std::span<const tool::Hull> hulls,
                           std::span<const RolledPose> poses, double tolerance, const Progress& progress) {
  return touched_by(grid, hulls, poses, tolerance, progress);
}

}  // namespace riffler::sweep
