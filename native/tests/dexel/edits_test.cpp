// Clipping, pieces and points of volumes against closed forms and a search through voxels.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <random>
#include <stdexcept>

#include "dexel/volumes.hpp"
#include "riffler/dexel/boolean.hpp"
#include "riffler/dexel/clip.hpp"
#include "riffler/dexel/contains.hpp"
#include "riffler/dexel/parts.hpp"
#include "riffler/sweep/carve.hpp"
#include "riffler/tool/cutters.hpp"

namespace riffler::dexel::edits_test {
namespace {

std::vector<Span> clipped(std::span<const Span> ray, const Vec3& foot, const Vec3& along, const Vec3& p,
                          const Vec3& n) {
  std::vector<Span> out;
  const double slope = glm::dot(along, n), off = glm::dot(foot - p, n);
  for (Span s : ray) {
    if (slope == 0) {
      if (off > 0) continue;
    } else if (slope > 0) {
      s.far = std::min(s.far, -off / slope);
    } else {
      s.near = std::max(s.near, -off / slope);
    }
    if (s.near < s.far) out.push_back(s);
  }
  return out;
}

TEST(Clip, CutsEveryRayWhereThePlaneCrossesIt) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> place(2, 22);
  for (const char* directions : {"z", "y", "xyz"})
    for (int k = 0; k < 12; ++k) {
      const Volume before = test::random_volume(test::lattice_frame(directions), 20 + k);
      const Vec3 p{place(random), place(random), place(random)};
      Vec3 n{normal(random), normal(random), normal(random)};
      if (k < 3) n = Vec3(k == 0, k == 1, k == 2) * 1e-3;  // walls along the rays
      Volume volume = before;
      clip(volume, p, n);
      for (std::size_t g = 0; g < volume.grids().size(); ++g) {
        const Grid& grid = volume.grids()[g];
        const Vec3 along = to_world(grid.axis(), {0, 0, 1});
        for (int i = 0; i < grid.nu(); ++i)
          for (int j = 0; j < grid.nv(); ++j) {
            const Vec3 foot = to_world(grid.axis(), {grid.u(i), grid.v(j), 0});
            const std::vector<Span> expected = clipped(before.grids()[g].ray(i, j), foot, along, p, glm::normalize(n));
            const std::span<const Span> ray = grid.ray(i, j);
            ASSERT_EQ(ray.size(), expected.size());
            for (std::size_t s = 0; s < ray.size(); ++s) {
              ASSERT_NEAR(ray[s].near, expected[s].near, 1e-7);
              ASSERT_NEAR(ray[s].far, expected[s].far, 1e-7);
            }
          }
      }
    }
}

TEST(Clip, TheNewFaceHasThePlanesNormal) {
  Volume volume = Volume::block({{{0, 0, 0}, {20, 20, 20}}, 0.5, "xyz"});
  const Vec3 n = glm::normalize(Vec3(1, 2, 3));
  clip(volume, {10, 10, 10}, n);
  std::size_t found = 0;
  for (const Grid& grid : volume.grids()) {
    const Span box{grid.box().lower.z, grid.box().upper.z};
    for (int i = 0; i < grid.nu(); ++i)
      for (int j = 0; j < grid.nv(); ++j)
        if (!grid.ray(i, j).empty() && grid.ray(i, j)[0].far < box.far) {
          EXPECT_LT(glm::length(grid.ray_normals(i, j)[0].far.unpack() - n), 1e-4);
          ++found;
        }
  }
  EXPECT_GT(found, 2000U);
  EXPECT_NEAR(volume.volume(), 4000, 1e-6);  // through the centre: a half, by symmetry
}

TEST(Clip, KeepsMaterialBehindThePlaneAndRemovesTheRest) {
  const Volume before = test::random_volume(test::lattice_frame("xyz"), 4);
  Volume volume = before;
  clip(volume, {0, 0, 30}, {0, 0, 2});
  EXPECT_EQ(volume.revision(), before.revision());
  clip(volume, {0, 0, -1}, {0, 0, 2});
  EXPECT_EQ(volume.volume(), 0);
  EXPECT_THROW(clip(volume, {0, 0, 0}, {0, 0, 0}), std::invalid_argument);
  EXPECT_THROW(clip(volume, {0, 0, NAN}, {0, 0, 1}), std::invalid_argument);
}

TEST(Contains, UsesTheRayOfTheCell) {
  const Volume volume = test::random_volume(test::lattice_frame("z"), 9);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> place(-1, 25);
  std::vector<Vec3> points;
  for (int k = 0; k < 5000; ++k) points.push_back({place(random), place(random), place(random)});
  const std::vector<char> inside = contains(volume, points);
  int hits = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Vec3& p = points[k];
    bool expected = false;
    if (std::min({p.x, p.y, p.z}) >= 0 && std::max({p.x, p.y, p.z}) <= 24)
      for (const Span& s : volume.grids()[0].ray(static_cast<int>(p.x / 0.5), static_cast<int>(p.y / 0.5)))
        expected |= p.z >= s.near && p.z <= s.far;
    ASSERT_EQ(inside[k] != 0, expected);
    hits += expected;
  }
  EXPECT_GT(hits, 1000);
  EXPECT_FALSE(contains(volume, std::array{Vec3(NAN, 1, 1)})[0]);
}

TEST(Contains, TwoOfThreeDirectionsDecide) {
  Volume volume = Volume::block({{{0, 0, 0}, {20, 20, 20}}, 0.5, "xyz"});
  sweep::CarveOptions options;
  sweep::carve(volume, cutters::ball(12, 40), std::vector<Pose>(2, Pose{{10, 10, 4}, {0, 0, 1}}));
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> place(0, 20);
  for (int k = 0; k < 5000; ++k) {
    const Vec3 p{place(random), place(random), place(random)};
    const Vec3 near{p.x, p.y, std::min(p.z, 10.0)};
    const double off = glm::length(near - Vec3(10, 10, 10)) - 6;
    if (std::abs(off) < 0.5) continue;
    ASSERT_EQ(contains(volume, std::array{p})[0] != 0, off > 0);
  }
}

/// Pieces by a flood through the lattice's cells, which a volume of one direction stands for exactly.
std::vector<double> flooded(const Volume& volume) {
  const Grid& grid = volume.reference();
  const auto solid = [&](int i, int j, int k) {
    for (const Span& s : grid.ray(i, j))
      if (k + 0.5 > s.near && k + 0.5 < s.far) return true;
    return false;
  };
  const int n = grid.nu();
  std::vector<char> seen(static_cast<std::size_t>(n) * n * test::kCells);
  const auto at = [&](int i, int j, int k) { return (static_cast<std::size_t>(i) * n + j) * test::kCells + k; };
  std::vector<double> sizes;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < test::kCells; ++k) {
        if (seen[at(i, j, k)] || !solid(i, j, k)) continue;
        std::vector<std::array<int, 3>> open{{i, j, k}};
        seen[at(i, j, k)] = 1;
        double size = 0;
        while (!open.empty()) {
          const auto [a, b, c] = open.back();
          open.pop_back();
          size += grid.pitch() * grid.pitch();
          for (const auto& d : {std::array{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}) {
            const int x = a + d[0], y = b + d[1], z = c + d[2];
            if (x < 0 || y < 0 || z < 0 || x >= n || y >= n || z >= test::kCells) continue;
            if (seen[at(x, y, z)] || !solid(x, y, z)) continue;
            seen[at(x, y, z)] = 1;
            open.push_back({x, y, z});
          }
        }
        sizes.push_back(size);
      }
  std::sort(sizes.rbegin(), sizes.rend());
  return sizes;
}

TEST(Parts, AreThoseOfAFloodThroughTheCells) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    Volume volume = test::random_volume(test::lattice_frame("z"), seed);
    Volume walls = Volume::block(test::lattice_frame("z"));  // in between, so that there are pieces
    for (const double x : {6.0, 13.0})
      sweep::carve(walls, cutters::flat(2, 60), std::vector<Pose>{{{x, -5, -1}, {0, 0, 1}}, {{x, 30, -1}, {0, 0, 1}}});
    apply(Boolean::Intersect, volume, walls);
    const std::vector<double> expected = flooded(volume);
    ASSERT_GT(expected.size(), 3U);
    const std::vector<Volume> found = parts(volume);
    ASSERT_EQ(found.size(), expected.size());
    Volume sum(volume.frame());
    for (std::size_t k = 0; k < found.size(); ++k) {
      EXPECT_NEAR(found[k].volume(), expected[k], 1e-9);
      Volume both = sum;
      apply(Boolean::Intersect, both, found[k]);
      EXPECT_EQ(both.volume(), 0);
      apply(Boolean::Add, sum, found[k]);
    }
    EXPECT_TRUE(test::same_rays(sum, volume));
  }
}

TEST(Parts, OfATriDexelVolumeAreTheSamePiecesInAllDirections) {
  const Frame frame{{{0, 0, 0}, {40, 30, 20}}, 0.5, "xyz"};
  Volume volume = Volume::block(frame);
  // A lean cut right through: neither half is a box.
  const Vec3 lean = glm::normalize(Vec3(0, 1, 1));
  sweep::carve(volume, cutters::flat(3, 90),
               std::vector<Pose>{{Vec3(15, 15, 10) - 40.0 * lean, lean}, {Vec3(15, 15, 10) - 40.0 * lean, lean}});
  for (const double x : {10.0, 25.0})
    sweep::carve(volume, cutters::flat(3, 90), std::vector<Pose>{{{x, -5, -1}, {0, 0, 1}}, {{x, 40, -1}, {0, 0, 1}}});
  const std::vector<Volume> found = parts(volume);
  ASSERT_EQ(found.size(), 3U);
  Volume sum(frame);
  for (const Volume& part : found) {
    for (const Grid& grid : part.grids()) EXPECT_NEAR(grid.volume(), part.volume(), 0.02 * part.volume());
    apply(Boolean::Add, sum, part);
  }
  EXPECT_TRUE(test::same_rays(sum, volume));
  EXPECT_GE(found[0].volume(), found[1].volume());
  EXPECT_EQ(parts(volume, 1e9).size(), 1U);
  EXPECT_TRUE(test::same_rays(parts(volume, 1e9)[0], volume));
}

TEST(Parts, OfAnEmptyVolumeAreNoneAndOfOnePieceItself) {
  const Frame frame = test::lattice_frame("xyz");
  EXPECT_TRUE(parts(Volume(frame)).empty());
  const Volume block = Volume::block(frame);
  const std::vector<Volume> found = parts(block);
  ASSERT_EQ(found.size(), 1U);
  for (std::size_t g = 0; g < 3; ++g)
    for (std::size_t t = 0; t < block.grids()[g].tile_count(); ++t)
      EXPECT_EQ(found[0].grids()[g].shared_tile(t), block.grids()[g].shared_tile(t));
}

TEST(Parts, RefusesDustByItsCount) {
  Volume dust(test::lattice_frame("z"));
  dust.grids()[0].fill_tile(0, [](int i, int j, TileBuilder& builder) {
    for (int k = 0; k < 8; ++k)
      if ((i + j) % 2 == 0) builder.add({3.0 * k, 3.0 * k + 1});
  });
  try {
    parts(dust);
    ADD_FAILURE();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("has 4096 pieces, more than 1000"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace riffler::dexel::edits_test
