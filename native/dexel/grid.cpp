#include "dexel/grid.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <unordered_set>

namespace riffler {

int ray_count(double extent, double pitch) {
  return std::max(1, static_cast<int>(std::lround(extent / pitch)));
}

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
  tiles_u_ = (nu_ + kTileSide - 1) / kTileSide;
  tiles_v_ = (nv_ + kTileSide - 1) / kTileSide;
  const std::shared_ptr<const Tile> empty = make_shared_block<Tile>();
  tiles_.assign(static_cast<std::size_t>(tiles_u_) * tiles_v_, empty);
}

Tile& Grid::writable(std::size_t index) {
  std::shared_ptr<const Tile>& held = tiles_[index];
  if (held.use_count() == 1) {
    // The last other holder may have been a reader on another thread: see its reads done before writing.
    std::atomic_thread_fence(std::memory_order_acquire);
  } else {
    held = make_shared_block<Tile>(*held);
  }
  return const_cast<Tile&>(*held);  // every tile is made by make_shared_block<Tile>, never as a const object
}

double Grid::volume() const {
  double sum = 0;
  for (const auto& tile : tiles_) {
    double in_tile = 0;
    for (const Span& s : tile->spans) in_tile += s.length();
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

}  // namespace riffler
