#include "marching/signs.hpp"

#include <algorithm>
#include <bit>

#include "riffler/base/parallel.hpp"

namespace riffler::marching {

namespace {

std::uint32_t low_bits(int count) {
  return count >= 32 ? ~std::uint32_t{0} : (std::uint32_t{1} << count) - 1;
}

/// The bits of the points of `range` among the 32 from `base` on.
std::uint32_t bits_of(const PointRange& range, int base) {
  const int first = std::max(range.first - base, 0), last = std::min(range.last - base, kBrickSide - 1);
  return first > last ? 0 : low_bits(last + 1) & ~low_bits(first);
}

/// Transposes a 32 × 32 bit matrix in place: bit c of row r ↔ bit r of row c (Warren, Hacker's Delight, 2nd ed., §7-3).
void transpose(std::uint32_t* rows) {
  std::uint32_t mask = 0x0000ffff;
  for (int width = 16; width; width >>= 1, mask ^= mask << width)
    for (int r = 0; r < 32; r = (r + width + 1) & ~width) {
      const std::uint32_t swap = ((rows[r] >> width) ^ rows[r + width]) & mask;
      rows[r] ^= swap << width;
      rows[r + width] ^= swap;
    }
}

/// Indices of the rays through the lattice points `base` … `base` + 31.
struct RayRange {
  int first, last;
  RayRange(int base, int rays) : first(std::max(base - 1, 0)), last(std::min(base + kBrickSide - 2, rays - 1)) {}
};

/// Calls visit(u, v, spans) for the rays u × v of a grid, tile by tile.
template <class Visit>
void for_rays(const dexel::Grid& grid, const RayRange& us, const RayRange& vs, Visit&& visit) {
  for (int a = us.first / dexel::kTileSide; a <= us.last / dexel::kTileSide; ++a)
    for (int b = vs.first / dexel::kTileSide; b <= vs.last / dexel::kTileSide; ++b) {
      const dexel::Tile& tile = grid.tile(grid.tile_index(a, b));
      if (tile.spans.empty()) continue;
      const int u0 = std::max(us.first, a * dexel::kTileSide),
                u1 = std::min(us.last, a * dexel::kTileSide + dexel::kTileSide - 1);
      const int v0 = std::max(vs.first, b * dexel::kTileSide),
                v1 = std::min(vs.last, b * dexel::kTileSide + dexel::kTileSide - 1);
      for (int u = u0; u <= u1; ++u)
        for (int v = v0; v <= v1; ++v) visit(u, v, tile.ray(dexel::Grid::ray_index(u, v)));
    }
}

}  // namespace

SignReader::SignReader(const Lattice& lattice)
    : lattice_(lattice), points_x_(lattice, 0), points_y_(lattice, 1), points_z_(lattice, 2) {}

void SignReader::follow(const Volume& volume) {
  reference_ = &volume.reference();
  if (volume.grids().size() != 3) return;
  x_ = volume.grid(Axis::X), y_ = volume.grid(Axis::Y);
  extents_.resize(y_->tile_count());
  base::parallel_for(extents_.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const dexel::Tile& tile = y_->tile(t);
      TileExtent& e = extents_[t];
      if (e.revision == tile.revision) continue;
      e = {lattice_.points(1), -1, 0, lattice_.points(1), tile.revision};
      for (const dexel::Span& s : tile.spans) {
        const PointRange range = points_y_(s);
        if (range.first > range.last) {
          e.core_last = -1;
          continue;
        }
        e.hull_first = std::min(e.hull_first, range.first), e.hull_last = std::max(e.hull_last, range.last);
        e.core_first = std::max(e.core_first, range.first), e.core_last = std::min(e.core_last, range.last);
      }
      // A ray with two spans contains less than their common part, and one without spans contains nothing.
      if (!tile.offset.one_each()) e.core_last = -1;
    }
  });
}

void SignReader::read(Bricks& bricks, int a, int b, int c0, int c1) const {
  thread_local Rows rows;
  rows.resize(static_cast<std::size_t>(c1 - c0 + 1));
  read_reference(a, b, c0, c1, rows);
  for (int c = c0; c <= c1; ++c) {
    SignRows& z = rows[static_cast<std::size_t>(c - c0)];
    if (y_) {
      const std::optional<bool> sign = common_sign(z);
      if (!sign || !agree({a, b, c}, *sign)) {
        SignRows y;
        read_y({a, b, c}, y);
        vote({a, b, c}, y, z);
      }
    }
    bricks.set_signs(bricks.index(a, b, c), z);
  }
}

/// Reads the rays along the columns of a column of bricks.
void SignReader::read_reference(int a, int b, int c0, int c1, Rows& rows) const {
  for (SignRows& r : rows) r.fill(0);
  const RayRange is(a * kBrickSide, lattice_.rays(0)), js(b * kBrickSide, lattice_.rays(1));
  for_rays(*reference_, is, js, [&](int i, int j, std::span<const dexel::Span> spans) {
    const int row = ((i + 1) & 31) * kBrickSide + ((j + 1) & 31);
    for (const dexel::Span& s : spans) {
      const PointRange range = y_ ? points_z_(s) : points_z_.or_nearest(s);
      if (range.first > range.last) continue;
      const int low = range.first >> 5, high = range.last >> 5;
      for (int c = std::max(low, c0); c <= std::min(high, c1); ++c)
        rows[static_cast<std::size_t>(c - c0)][row] |=
            low < c && c < high ? ~std::uint32_t{0} : bits_of(range, c * kBrickSide);
    }
  });
}

/// Whether the y rays classify all points of a brick as the z rays do, judged from their tiles alone.
bool SignReader::agree(const Vec3i& brick, bool inside) const {
  const RayRange is(brick.x * kBrickSide, lattice_.rays(0)), ks(brick.z * kBrickSide, lattice_.rays(2));
  const int first = std::max(brick.y * kBrickSide, 1),
            last = std::min(brick.y * kBrickSide + kBrickSide - 1, lattice_.rays(1));
  for (int u = ks.first / dexel::kTileSide; u <= ks.last / dexel::kTileSide; ++u)
    for (int v = is.first / dexel::kTileSide; v <= is.last / dexel::kTileSide; ++v) {
      const TileExtent& e = extents_[y_->tile_index(u, v)];
      if (inside ? e.core_first > first || e.core_last < last : e.hull_first <= last && e.hull_last >= first)
        return false;
    }
  return true;
}

void SignReader::read_y(const Vec3i& brick, SignRows& rows) const {
  rows.fill(0);
  const RayRange is(brick.x * kBrickSide, lattice_.rays(0)), ks(brick.z * kBrickSide, lattice_.rays(2));
  const int base = brick.y * kBrickSide;
  for_rays(*y_, ks, is, [&](int k, int i, std::span<const dexel::Span> spans) {
    std::uint32_t bits = 0;
    for (const dexel::Span& s : spans) bits |= bits_of(points_y_(s), base);
    rows[((i + 1) & 31) * kBrickSide + ((k + 1) & 31)] = bits;
  });
  for (int i = 0; i < kBrickSide; ++i) transpose(rows.data() + i * kBrickSide);
}

/// Where z and y rays agree, they are the majority; elsewhere the x ray decides.
void SignReader::vote(const Vec3i& brick, const SignRows& y, SignRows& z) const {
  for (int row = 0; row < kBrickColumns; ++row)
    for (std::uint32_t differ = y[row] ^ z[row]; differ; differ &= differ - 1) {
      const int k = std::countr_zero(differ);
      const std::uint32_t bit = differ & (~differ + 1);
      const bool inside = along_x(brick.x * kBrickSide + row / kBrickSide, brick.y * kBrickSide + row % kBrickSide,
                                  brick.z * kBrickSide + k);
      z[row] = inside ? z[row] | bit : z[row] & ~bit;
    }
}

bool SignReader::along_x(int i, int j, int k) const {
  for (const dexel::Span& s : x_->ray(j - 1, k - 1)) {
    const PointRange range = points_x_(s);
    if (range.first <= i && i <= range.last) return true;
  }
  return false;
}

void read_signs(const SignReader& reader, Bricks& bricks, const Progress& progress) {
  base::parallel_for(
      static_cast<std::size_t>(bricks.count(0)) * bricks.count(1), 1,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n)
          reader.read(bricks, static_cast<int>(n) / bricks.count(1), static_cast<int>(n) % bricks.count(1), 0,
                      bricks.count(2) - 1);
      },
      progress);
}

}  // namespace riffler::marching
