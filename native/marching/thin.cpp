#include "riffler/marching/thin.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/functions.hpp"
#include "marching/lattice.hpp"
#include "marching/signs.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::marching {

namespace {

/// The world axis that a grid's rays run along.
int along(const dexel::Grid& grid) {
  return static_cast<int>(grid.axis());
}

bool misses(const PointsOfSpan& points, const dexel::Span& s) {
  const PointRange range = points(s);
  return range.first > range.last;
}

/// A span without a lattice point, on ray (i, j).
struct Miss {
  int i, j;
  dexel::Span span;
};

/// The spans without a lattice point of one direction, tile by tile.
std::vector<Miss> missing(const dexel::Grid& grid, const PointsOfSpan& points) {
  std::vector<std::vector<Miss>> tiles(grid.tile_count());
  base::parallel_for(tiles.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const dexel::Tile& tile = grid.tile(t);
      if (std::none_of(tile.spans.begin(), tile.spans.end(), [&](const dexel::Span& s) { return misses(points, s); }))
        continue;
      const int i0 = static_cast<int>(t) / grid.tiles_v() * dexel::kTileSide,
                j0 = static_cast<int>(t) % grid.tiles_v() * dexel::kTileSide;
      for (int r = 0; r < dexel::kTileRays; ++r)
        for (const dexel::Span& s : tile.ray(r))
          if (misses(points, s)) tiles[t].push_back({i0 + r / dexel::kTileSide, j0 + r % dexel::kTileSide, s});
    }
  });
  std::vector<Miss> out;
  for (const std::vector<Miss>& tile : tiles) out.insert(out.end(), tile.begin(), tile.end());
  return out;
}

/// Calls visit(i, j) for the rays around a ray until it returns true. Returns whether it did.
template <class Visit>
bool any_around(const dexel::Grid& grid, const Miss& m, const Visit& visit) {
  for (int i = std::max(0, m.i - 1); i <= std::min(grid.nu() - 1, m.i + 1); ++i)
    for (int j = std::max(0, m.j - 1); j <= std::min(grid.nv() - 1, m.j + 1); ++j)
      if ((i != m.i || j != m.j) && visit(i, j)) return true;
  return false;
}

/// Whether an adjacent ray has a lattice point in the same material: then the mesh reaches there, or nearly.
bool is_edge(const dexel::Grid& grid, const PointsOfSpan& points, const Miss& m) {
  return any_around(grid, m, [&](int i, int j) {
    for (const dexel::Span& s : grid.ray(i, j))
      if (s.near <= m.span.far && s.far >= m.span.near && !misses(points, s)) return true;
    return false;
  });
}

/// Slightly less than the length exceeded by nine tenths of the volume, to two figures.
double kept_by(std::vector<std::pair<double, double>> lengths, double total) {
  std::sort(lengths.begin(), lengths.end());
  double sum = 0, length = 0;
  for (const auto& [l, volume] : lengths) {
    length = l;
    if ((sum += volume) > 0.1 * total) break;
  }
  const double unit = base::pow(10, std::floor(base::log10(length)) - 1);
  return std::floor(0.99 * length / unit) * unit;
}

/// The thin material seen by one direction.
ThinMaterial seen_by(const dexel::Grid& grid, const PointsOfSpan& points) {
  const std::vector<Miss> found = missing(grid, points);
  ThinMaterial out;
  std::vector<std::size_t> lost;  // indices of the rays
  const auto place = [&](int i, int j) { return static_cast<std::size_t>(i) * grid.nv() + j; };
  for (const Miss& m : found)
    if (!is_edge(grid, points, m)) lost.push_back(place(m.i, m.j));
  if (lost.empty()) return out;
  std::sort(lost.begin(), lost.end());
  const auto is_lost = [&](int i, int j) { return std::binary_search(lost.begin(), lost.end(), place(i, j)); };
  std::vector<std::pair<double, double>> lengths;  // with their volumes
  Box3 box;
  for (const Miss& m : found) {
    if (!is_lost(m.i, m.j) && !any_around(grid, m, is_lost)) continue;
    const double volume = m.span.length() * grid.area(m.i, m.j);
    out.volume += volume;
    lengths.emplace_back(m.span.length(), volume);
    const double u = grid.u(m.i) - 0.5 * grid.pitch(), v = grid.v(m.j) - 0.5 * grid.pitch();
    box.add({u, v, m.span.near}), box.add({u + grid.width_u(m.i), v + grid.width_v(m.j), m.span.far});
  }
  out.box.add(to_world(grid.axis(), box.lower)), out.box.add(to_world(grid.axis(), box.upper));
  out.pitch = kept_by(std::move(lengths), out.volume);
  out.notable = lost.size() >= 4 || out.volume > 0.01 * grid.volume();
  return out;
}

}  // namespace

ThinMaterial thin_material(const Volume& volume) {
  ThinMaterial out;
  if (volume.grids().size() != 3) return out;
  const Lattice lattice(volume);
  for (const dexel::Grid& grid : volume.grids()) {
    const ThinMaterial seen = seen_by(grid, PointsOfSpan(lattice, along(grid)));
    if (seen.volume > out.volume) out = seen;
  }
  return out;
}

}  // namespace riffler::marching
