// All rays of one direction, in tiles that snapshots share.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "riffler/dexel/tile.hpp"
#include "riffler/geom/vec.hpp"

namespace riffler::dexel {

/// Rays along `axis` in its cyclic frame (u, v, w): ray (i, j), 0 ≤ i < nu, 0 ≤ j < nv, is at (lower.u + (i + ½) h,
/// lower.v + (j + ½) h) with h the pitch. Copying a grid copies only pointers to tiles.
class Grid {
 public:
  /// An empty grid over `box` (world frame, mm).
  Grid(Axis axis, const Box3& box, double pitch, bool with_normals);

  Axis axis() const { return axis_; }
  double pitch() const { return pitch_; }
  /// Number of rays along u and v.
  int nu() const { return nu_; }
  int nv() const { return nv_; }
  /// Number of tiles along u and v.
  int tiles_u() const { return tiles_u_; }
  int tiles_v() const { return tiles_v_; }
  /// Whether spans have normals at their ends.
  bool has_normals() const { return with_normals_; }
  /// The box in the cyclic frame: its x, y, z are u, v, w.
  const Box3& box() const { return box_; }

  /// Ray position that algorithms use: ray (i, j) shifted slightly, so that rays exactly on a wall, edge or vertex are
  /// always decided the same way. Example: if two walls are a whole number of pitches apart, exactly one of them takes
  /// the ray.
  static constexpr double kRayShift = 5e-10;  // pitches, along v; 0.7 of it along u
  double shifted_u(int i) const { return u(i) + 0.7 * kRayShift * pitch_; }
  double shifted_v(int j) const { return v(j) + kRayShift * pitch_; }

  /// Exact position of ray (i, j), mm: the middle of a cell.
  double u(int i) const { return box_.lower.x + (i + 0.5) * pitch_; }
  double v(int j) const { return box_.lower.y + (j + 0.5) * pitch_; }

  /// Cell widths of ray (i, j), mm: the pitch, except for the last cells, which end at the box. If the box side is no
  /// multiple of the pitch, they are 0.5 to 1.5 pitches wide, or less if the box is thinner than half a pitch.
  double width_u(int i) const { return i + 1 < nu_ ? pitch_ : last_u_; }
  double width_v(int j) const { return j + 1 < nv_ ? pitch_ : last_v_; }
  /// Area of the cell of ray (i, j), mm².
  double area(int i, int j) const { return width_u(i) * width_v(j); }
  /// Smallest cell area, mm².
  double least_area() const;
  /// Whether all cells along u or v are one pitch wide.
  bool even_u() const { return last_u_ == pitch_; }
  bool even_v() const { return last_v_ == pitch_; }

  std::size_t tile_count() const { return tiles_.size(); }
  /// Number of the tile in row `tile_u`, column `tile_v` of the tiles.
  std::size_t tile_index(int tile_u, int tile_v) const { return static_cast<std::size_t>(tile_u) * tiles_v_ + tile_v; }
  /// Tiles by number.
  const Tile& tile(std::size_t index) const { return *tiles_[index]; }
  const std::shared_ptr<const Tile>& shared_tile(std::size_t index) const { return tiles_[index]; }
  void set_tile(std::size_t index, std::shared_ptr<const Tile> tile) { tiles_[index] = std::move(tile); }
  /// Replaces a tile. add(i, j, builder) adds the spans of ray (i, j); it is called for each ray of the tile that lies
  /// in the grid.
  template <class Add>
  void fill_tile(std::size_t index, Add&& add) {
    const int i0 = static_cast<int>(index) / tiles_v_ * kTileSide, j0 = static_cast<int>(index) % tiles_v_ * kTileSide;
    TileBuilder builder(with_normals_);
    for (int i = i0; i < i0 + kTileSide; ++i)
      for (int j = j0; j < j0 + kTileSide; ++j) {
        if (i < nu_ && j < nv_) add(i, j, builder);
        builder.next_ray();
      }
    set_tile(index, builder.finish());
  }
  /// Gives every ray one span through the whole box. Tiles of equal shape share their storage until they are cut.
  void fill();

  /// The spans of ray (i, j), sorted and disjoint.
  std::span<const Span> ray(int i, int j) const { return owner(i, j).ray(ray_index(i, j)); }
  /// The normals at the ends of these spans; empty if the grid stores none.
  std::span<const SpanNormals> ray_normals(int i, int j) const { return owner(i, j).ray_normals(ray_index(i, j)); }
  /// Number of ray (i, j) in its tile.
  static int ray_index(int i, int j) { return (i % kTileSide) * kTileSide + j % kTileSide; }

  /// Sum of all span lengths × cell areas, mm³. Summed tile by tile, so it does not depend on the number of threads.
  double volume() const;
  /// Number of spans in all rays.
  std::size_t span_count() const;
  /// Bytes in use; each shared tile counts once.
  std::size_t nbytes() const;

 private:
  const Tile& owner(int i, int j) const { return *tiles_[tile_index(i / kTileSide, j / kTileSide)]; }

  Axis axis_;
  bool with_normals_;
  double pitch_;
  Box3 box_;
  int nu_, nv_, tiles_u_, tiles_v_;
  double last_u_, last_v_;  // widths of the last cells
  std::vector<std::shared_ptr<const Tile>> tiles_;
};

/// Number of rays along a side of length `extent` (mm): max(1, round(extent / pitch)).
int ray_count(double extent, double pitch);

/// First and last of n rays, `pitch` apart, whose coordinate lies in `range`.
std::pair<int, int> ray_indices(const Interval& range, double lower, double pitch, int n);

}  // namespace riffler::dexel
