#include "riffler/dexel/grid.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_set>

namespace riffler::dexel {

int ray_count(double extent, double pitch) {
  return std::max(1, static_cast<int>(std::lround(extent / pitch)));
}

namespace {

/// Width of the last of n cells along a side; exactly the pitch if only rounding makes the difference.
double last_width(double extent, int n, double pitch) {
  const double width = extent - (n - 1) * pitch;
  return std::abs(width - pitch) <= 1e-9 * pitch * n ? pitch : width;
}

}  // namespace

std::pair<int, int> ray_indices(const Interval& range, double lower, double pitch, int n) {
  if (range.empty()) return {0, -1};
  const double first = std::ceil((range.near - lower) / pitch - 0.5),
               last = std::floor((range.far - lower) / pitch - 0.5);
  return {static_cast<int>(std::clamp(first, 0.0, static_cast<double>(n))),
          static_cast<int>(std::clamp(last, -1.0, n - 1.0))};
}

Grid::Grid(Axis axis, const Box3& box, double pitch, bool with_normals)
    : axis_(axis), with_normals_(with_normals), pitch_(pitch), box_(to_local(axis, box)) {
  nu_ = ray_count(box_.size().x, pitch);
  nv_ = ray_count(box_.size().y, pitch);
  last_u_ = last_width(box_.size().x, nu_, pitch), last_v_ = last_width(box_.size().y, nv_, pitch);
  tiles_u_ = (nu_ + kTileSide - 1) / kTileSide;
  tiles_v_ = (nv_ + kTileSide - 1) / kTileSide;
  const std::shared_ptr<const Tile> empty = base::make_shared_block<Tile>();
  tiles_.assign(static_cast<std::size_t>(tiles_u_) * tiles_v_, empty);
}

void Grid::fill() {
  const Span span{box_.lower.z, box_.upper.z};
  const Vec3 along = to_world(axis_, Vec3(0, 0, 1));
  const SpanNormals normals{PackedNormal::pack(-along), PackedNormal::pack(along)};
  std::shared_ptr<const Tile> shared[2][2];  // inner, last row, last column, corner
  for (int a = 0; a < tiles_u_; ++a)
    for (int b = 0; b < tiles_v_; ++b) {
      const std::size_t t = tile_index(a, b);
      auto& tile = shared[a == tiles_u_ - 1][b == tiles_v_ - 1];
      if (!tile) {
        fill_tile(t, [&](int, int, TileBuilder& builder) { builder.add(span, normals); });
        tile = tiles_[t];
      }
      tiles_[t] = tile;
    }
}

double Grid::least_area() const {
  return std::min(pitch_, last_u_) * std::min(pitch_, last_v_);
}

double Grid::volume() const {
  double sum = 0;  // sum of lengths; at the border weighted by cell area / h²
  for (int a = 0; a < tiles_u_; ++a)
    for (int b = 0; b < tiles_v_; ++b) {
      const Tile& tile = *tiles_[tile_index(a, b)];
      double in_tile = 0;
      const bool uneven = (a + 1 == tiles_u_ && !even_u()) || (b + 1 == tiles_v_ && !even_v());
      if (!uneven) {
        for (const Span& s : tile.spans) in_tile += s.length();
      } else {
        const int rows = std::min(kTileSide, nu_ - a * kTileSide), columns = std::min(kTileSide, nv_ - b * kTileSide);
        for (int i = 0; i < rows; ++i)
          for (int j = 0; j < columns; ++j) {
            double on_ray = 0;
            for (const Span& s : tile.ray(i * kTileSide + j)) on_ray += s.length();
            in_tile += on_ray * (width_u(a * kTileSide + i) / pitch_) * (width_v(b * kTileSide + j) / pitch_);
          }
      }
      sum += in_tile;
    }
  return sum * pitch_ * pitch_;
}

std::size_t Grid::span_count() const {
  std::size_t n = 0;
  for (const auto& tile : tiles_) n += tile->spans.size();
  return n;
}

std::size_t Grid::nbytes() const {
  std::unordered_set<const Tile*> seen;
  std::size_t bytes = tiles_.capacity() * sizeof tiles_[0];
  for (const auto& tile : tiles_)
    if (seen.insert(tile.get()).second) bytes += tile->nbytes();
  return bytes;
}

}  // namespace riffler::dexel
