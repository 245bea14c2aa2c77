// If rays move by whole tiles, tiles are reused unchanged. Otherwise each new tile is assembled from up to four old
// ones, once for each distinct combination: the inner tiles of a block are one shared tile and stay one.
#include "riffler/dexel/grown.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <vector>

#include "riffler/base/check.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::dexel {

namespace {

/// In pitches: a box may end this much short of the wanted box, so that rounding adds no ray.
constexpr double kShort = 1e-6;

/// Number of whole pitches in `d` (mm), rounded up; 0 for negative d.
double pitches(double d, double pitch) {
  return d > 0 ? std::ceil(d / pitch - kShort) : 0;
}

/// The old tiles that meet in one new tile, by [later in u][later in v]; null outside the old grid.
using Four = std::array<std::shared_ptr<const Tile>, 4>;

/// Moves the rays of a grid by (du, dv) places, both ≥ 0, into a larger one.
class TileMover {
 public:
  TileMover(const Grid& from, int du, int dv)
      : from_(from),
        tiles_u_(du / kTileSide),
        tiles_v_(dv / kTileSide),
        rays_u_(du % kTileSide),
        rays_v_(dv % kTileSide) {}

  bool whole_tiles() const { return rays_u_ == 0 && rays_v_ == 0; }
  /// The old tiles that meet in tile (u, v) of the new grid.
  Four meeting(int u, int v) const {
    Four four;
    for (int k = 0; k < 4; ++k) {
      const bool used = (k / 2 == 1 || rays_u_ > 0) && (k % 2 == 1 || rays_v_ > 0);
      if (used) four[k] = old(u - tiles_u_ - 1 + k / 2, v - tiles_v_ - 1 + k % 2);
    }
    return four;
  }
  std::shared_ptr<const Tile> joined(const Four& four) const {
    TileBuilder builder(from_.has_normals());
    for (int a = 0; a < kTileSide; ++a)
      for (int b = 0; b < kTileSide; ++b) {
        const Tile* tile = four[(a >= rays_u_) * 2 + (b >= rays_v_)].get();
        if (tile) add(*tile, Grid::ray_index(a - rays_u_ + kTileSide, b - rays_v_ + kTileSide), builder);
        builder.next_ray();
      }
    return builder.finish();
  }

 private:
  std::shared_ptr<const Tile> old(int u, int v) const {
    if (u < 0 || u >= from_.tiles_u() || v < 0 || v >= from_.tiles_v()) return nullptr;
    const std::shared_ptr<const Tile>& tile = from_.shared_tile(from_.tile_index(u, v));
    return tile->spans.empty() ? nullptr : tile;
  }
  void add(const Tile& tile, int ray, TileBuilder& builder) const {
    const std::span<const Span> spans = tile.ray(ray);
    const std::span<const SpanNormals> normals = tile.ray_normals(ray);
    for (std::size_t k = 0; k < spans.size(); ++k) builder.add(spans[k], normals.empty() ? SpanNormals{} : normals[k]);
  }

  const Grid& from_;
  int tiles_u_, tiles_v_, rays_u_, rays_v_;
};

void move_rays(const Grid& from, Grid& to, int du, int dv, const Progress& progress) {
  const TileMover mover(from, du, dv);
  std::map<Four, std::size_t> known;
  std::vector<Four> work;
  std::vector<std::pair<std::size_t, std::size_t>> places;  // (tile of the new grid, index in `work`)
  for (int u = du / kTileSide; u < to.tiles_u(); ++u)
    for (int v = dv / kTileSide; v < to.tiles_v(); ++v) {
      const Four four = mover.meeting(u, v);
      if (four == Four{}) continue;
      const auto [at, added] = known.try_emplace(four, work.size());
      if (added) work.push_back(four);
      places.emplace_back(to.tile_index(u, v), at->second);
    }
  std::vector<std::shared_ptr<const Tile>> made(work.size());
  base::parallel_for(
      work.size(), 16,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k)
          made[k] = mover.whole_tiles() ? work[k].back() : mover.joined(work[k]);
      },
      progress);
  for (const auto& [tile, k] : places) to.set_tile(tile, made[k]);
}

}  // namespace

Frame grown(const Frame& frame, const Box3& wanted) {
  base::require(geom::finite(wanted.lower), "lower", "must be finite");
  base::require(geom::finite(wanted.upper), "upper", "must be finite");
  if (wanted.empty()) throw std::invalid_argument("lower must not be above upper");
  Frame out = frame;
  const double h = frame.pitch;
  for (int k = 0; k < 3; ++k) {
    const double lower = frame.box.lower[k], upper = frame.box.upper[k];
    const double below = pitches(lower - wanted.lower[k], h), above = pitches(wanted.upper[k] - upper, h);
    out.box.lower[k] = lower - below * h, out.box.upper[k] = upper + above * h;
    // A last cell of half a pitch or less may now round to no ray of its own.
    const double extent = out.box.size()[k];
    if (extent < 1e9 * h && ray_count(extent, h) < ray_count(upper - lower, h) + static_cast<int>(below))
      out.box.upper[k] = upper + (above + 1) * h;
  }
  return out;
}

Volume grown(const Volume& volume, const Box3& wanted, const Progress& progress) {
  const Frame frame = grown(volume.frame(), wanted);
  if (frame == volume.frame()) return volume.snapshot();
  Volume out(frame);
  const Vec3 moved = (volume.frame().box.lower - frame.box.lower) / frame.pitch;
  const double share = 1.0 / static_cast<double>(out.grids().size());
  for (std::size_t g = 0; g < out.grids().size(); ++g) {
    Grid& grid = out.grids()[g];
    const Vec3 local = to_local(grid.axis(), moved);
    move_rays(volume.grids()[g], grid, static_cast<int>(std::lround(local.x)), static_cast<int>(std::lround(local.y)),
              base::part(progress, static_cast<double>(g) * share, static_cast<double>(g + 1) * share));
  }
  return out;
}

}  // namespace riffler::dexel
