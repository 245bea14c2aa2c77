#include "marching/thin.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "geom/parallel.hpp"
#include "marching/lattice.hpp"
#include "marching/signs.hpp"

namespace riffler {

namespace {

using namespace marching;

/// The axis of the world that a grid's rays run along.
int along(const Grid& grid) {
  return static_cast<int>(grid.axis());
}

bool misses(const PointsOfSpan& points, const Span& s) {
  const PointRange range = points(s);
  return range.first > range.last;
}

/// What one tile's rays miss, mm³, and whether three rows of three rays miss something beside each other.
struct TileMiss {
  double volume = 0;
  bool sheet = false;
};

TileMiss look(const Grid& grid, std::size_t index, const PointsOfSpan& points) {
  TileMiss out;
  const Tile& tile = grid.tile(index);
  if (std::none_of(tile.spans.begin(), tile.spans.end(), [&](const Span& s) { return misses(points, s); })) return out;
  const int i0 = static_cast<int>(index) / grid.tiles_v() * kTileSide,
            j0 = static_cast<int>(index) % grid.tiles_v() * kTileSide;
  std::uint32_t rows[kTileSide] = {};  // a bit for each ray
  for (int r = 0; r < kTileRays; ++r)
    for (const Span& s : tile.ray(r))
      if (misses(points, s)) {
        out.volume += s.length() * grid.area(i0 + r / kTileSide, j0 + r % kTileSide);
        rows[r / kTileSide] |= std::uint32_t{1} << r % kTileSide;
      }
  for (int a = 0; a + 2 < kTileSide; ++a) {
    const std::uint32_t common = rows[a] & rows[a + 1] & rows[a + 2];
    out.sheet |= (common & common >> 1 & common >> 2) != 0;
  }
  return out;
}

TileMiss look(const Grid& grid, const PointsOfSpan& points) {
  std::vector<TileMiss> tiles(grid.tile_count());
  parallel_for(tiles.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) tiles[t] = look(grid, t, points);
  });
  TileMiss out;
  for (const TileMiss& t : tiles) out.volume += t.volume, out.sheet |= t.sheet;
  out.sheet |= out.volume > 0 && (grid.nu() < 3 || grid.nv() < 3);
  return out;
}

/// What one direction sees.
class Missing {
 public:
  Missing(const Grid& grid, const PointsOfSpan& points)
      : grid_(grid), spans_(static_cast<std::size_t>(grid.nu()) * grid.nv(), Span{0, 0}) {
    for (int i = 0; i < grid.nu(); ++i)
      for (int j = 0; j < grid.nv(); ++j)
        for (const Span& s : grid.ray(i, j))
          if (misses(points, s)) add(i, j, s);
  }

  ThinMaterial result() const {
    ThinMaterial out{volume_, {}, 0, false};
    if (!(volume_ > 0)) return out;
    out.box.add(to_world(grid_.axis(), box_.lower)), out.box.add(to_world(grid_.axis(), box_.upper));
    out.pitch = kept_by();
    for (int i = 1; i + 1 < grid_.nu() && !out.sheets; ++i)
      for (int j = 1; j + 1 < grid_.nv() && !out.sheets; ++j) out.sheets = is_middle(i, j);
    // A plate that is one or two rays wide is all there is of it.
    if (grid_.nu() < 3 || grid_.nv() < 3) out.sheets = true;
    return out;
  }

 private:
  void add(int i, int j, const Span& s) {
    spans_[place(i, j)] = s;
    const double volume = s.length() * grid_.area(i, j);
    volume_ += volume;
    lengths_.emplace_back(s.length(), volume);
    const double u = grid_.u(i) - 0.5 * grid_.pitch(), v = grid_.v(j) - 0.5 * grid_.pitch();
    box_.add({u, v, s.near}), box_.add({u + grid_.width_u(i), v + grid_.width_v(j), s.far});
  }

  std::size_t place(int i, int j) const { return static_cast<std::size_t>(i) * grid_.nv() + j; }

  /// Whether all eight neighbours lack material beside that of ray (i, j), too.
  bool is_middle(int i, int j) const {
    const Span& s = spans_[place(i, j)];
    if (!(s.near < s.far)) return false;
    for (int a = i - 1; a <= i + 1; ++a)
      for (int b = j - 1; b <= j + 1; ++b) {
        const Span& o = spans_[place(a, b)];
        if (!(o.near < o.far) || o.near > s.far + grid_.pitch() || o.far < s.near - grid_.pitch()) return false;
      }
    return true;
  }

  /// A little less than the length that nine tenths of the volume have at least, to two figures.
  double kept_by() const {
    std::vector<std::pair<double, double>> sorted = lengths_;
    std::sort(sorted.begin(), sorted.end());
    double sum = 0, length = 0;
    for (const auto& [l, volume] : sorted) {
      length = l;
      if ((sum += volume) > 0.1 * volume_) break;
    }
    const double unit = std::pow(10, std::floor(std::log10(length)) - 1);
    return std::floor(0.99 * length / unit) * unit;
  }

  const Grid& grid_;
  std::vector<Span> spans_;  // the last of each ray that is missing
  std::vector<std::pair<double, double>> lengths_;
  Box3 box_;
  double volume_ = 0;
};

}  // namespace

ThinMaterial thin_material(const Volume& volume) {
  ThinMaterial out;
  if (volume.grids().size() != 3) return out;
  const Lattice lattice(volume);
  for (const Grid& grid : volume.grids()) {
    const PointsOfSpan points(lattice, along(grid));
    const TileMiss seen = look(grid, points);
    if (seen.volume <= out.volume) continue;
    out = {seen.volume, {}, 0, false};
    if (seen.sheet || seen.volume > kCrumbs * volume.volume()) out = Missing(grid, points).result();
  }
  return out;
}

}  // namespace riffler
