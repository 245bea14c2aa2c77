// Volumes for the tests of this folder: random spans on an integer lattice, and carved-looking ones.
#pragma once

#include <gtest/gtest.h>

#include <bitset>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "riffler/dexel/volume.hpp"

namespace riffler::test {

inline constexpr int kCells = 24;  ///< lattice cells along a ray
using Cells = std::bitset<kCells>;

/// A frame whose boxes have `kCells` units along every ray and a few odd tiles across it.
inline dexel::Frame lattice_frame(const std::string& directions, double pitch = 0.5) {
  return {{{0, 0, 0}, {kCells, kCells, kCells}}, pitch, directions};
}

/// Any normal that tells where it came from: distinct for a ray, an end and a source.
inline dexel::PackedNormal tag(std::mt19937& random) {
  std::normal_distribution<double> d;
  return dexel::PackedNormal::pack({d(random), d(random), d(random)});
}

/// The cells of a ray as spans.
inline void add_cells(dexel::TileBuilder& builder, const Cells& cells, std::mt19937& random) {
  for (int k = 0; k < kCells;) {
    if (!cells[k]) {
      ++k;
      continue;
    }
    int end = k;
    while (end < kCells && cells[end]) ++end;
    builder.add({double(k), double(end)}, {tag(random), tag(random)});
    k = end;
  }
}

inline Cells random_cells(std::mt19937& random) {
  switch (random() % 6) {
    case 0:
      return {};
    case 1:
      return Cells().set();
    case 2:
      return Cells(random() & random());
    case 3:
      return Cells(random() | random());
    default:
      return Cells(random());
  }
}

/// A volume of random cells; some tiles are empty, some full, some shared.
inline Volume random_volume(const dexel::Frame& frame, unsigned seed) {
  std::mt19937 random(seed);
  Volume volume(frame);
  const Volume block = Volume::block(frame);
  for (std::size_t g = 0; g < volume.grids().size(); ++g) {
    dexel::Grid& grid = volume.grids()[g];
    for (int a = 0; a < grid.tiles_u(); ++a)
      for (int b = 0; b < grid.tiles_v(); ++b) {
        const std::size_t t = grid.tile_index(a, b);
        const unsigned kind = random() % 8;
        if (kind == 0) continue;
        if (kind == 1) {
          grid.set_tile(t, block.grids()[g].shared_tile(t));
          continue;
        }
        grid.fill_tile(
            t, [&](int, int, dexel::TileBuilder& builder) { add_cells(builder, random_cells(random), random); });
      }
  }
  volume.touch();
  return volume;
}

/// The cells that a ray covers; fails the test where its spans are not on the lattice, sorted and disjoint.
inline Cells cells_of(std::span<const dexel::Span> spans) {
  Cells cells;
  double last = -1;
  for (const dexel::Span& s : spans) {
    EXPECT_LT(last, s.near);
    EXPECT_LT(s.near, s.far);
    EXPECT_EQ(s.near, std::floor(s.near));
    EXPECT_EQ(s.far, std::floor(s.far));
    for (int k = static_cast<int>(s.near); k < static_cast<int>(s.far); ++k) cells.set(k);
    last = s.far;
  }
  return cells;
}

/// Same frame, same rays, same normals.
inline ::testing::AssertionResult same_rays(const Volume& a, const Volume& b) {
  if (!(a.frame() == b.frame())) return ::testing::AssertionFailure() << "frames differ";
  for (std::size_t g = 0; g < a.grids().size(); ++g)
    for (std::size_t t = 0; t < a.grids()[g].tile_count(); ++t) {
      const dexel::Tile &x = a.grids()[g].tile(t), &y = b.grids()[g].tile(t);
      if (x.offset != y.offset || x.spans != y.spans || x.normals != y.normals)
        return ::testing::AssertionFailure() << "grid " << g << ", tile " << t << " differs";
    }
  return ::testing::AssertionSuccess();
}

/// The same spans; normals may differ.
inline ::testing::AssertionResult same_spans(const Volume& a, const Volume& b) {
  for (std::size_t g = 0; g < a.grids().size(); ++g)
    for (std::size_t t = 0; t < a.grids()[g].tile_count(); ++t)
      if (a.grids()[g].tile(t).offset != b.grids()[g].tile(t).offset ||
          a.grids()[g].tile(t).spans != b.grids()[g].tile(t).spans)
        return ::testing::AssertionFailure() << "grid " << g << ", tile " << t << " differs";
  return ::testing::AssertionSuccess();
}

/// A block under a wavy surface with a row of grooves: doubles with full mantissas where it is cut, flat elsewhere.
inline Volume wavy_volume(const dexel::Frame& frame) {
  Volume volume = Volume::block(frame);
  for (dexel::Grid& grid : volume.grids()) {
    const Vec3 lower = grid.box().lower, size = grid.box().size();
    for (int a = 0; a < grid.tiles_u(); ++a)
      for (int b = 0; b < grid.tiles_v(); ++b) {
        if ((a + b) % 3 == 0) continue;  // a third stays as it was
        grid.fill_tile(grid.tile_index(a, b), [&](int i, int j, dexel::TileBuilder& builder) {
          const double x = (grid.u(i) - lower.x) / size.x, y = (grid.v(j) - lower.y) / size.y;
          const double top = lower.z + size.z * (0.7 + 0.2 * std::sin(9 * x) * std::cos(7 * y));
          const dexel::PackedNormal n = dexel::PackedNormal::pack({std::cos(9 * x), std::sin(7 * y), 1});
          const double groove = lower.z + size.z * (0.3 + 0.1 * std::sin(11 * x * y));
          if (std::sin(40 * x) > 0.8) {
            builder.add({lower.z, groove}, {{}, n});
            builder.add({groove + 0.05 * size.z, top}, {n, n});
          } else {
            builder.add({lower.z, top}, {{}, n});
          }
        });
      }
  }
  volume.touch();
  return volume;
}

}  // namespace riffler::test
