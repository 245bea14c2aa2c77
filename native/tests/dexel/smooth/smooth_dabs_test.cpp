// The smooth brush against planes, spheres and boxes in closed form, and on what it must not break.
#include "riffler/dexel/smooth/smooth_dabs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <numbers>
#include <random>
#include <stdexcept>

#include "dexel/ends.hpp"
#include "dexel/solids.hpp"
#include "dexel/volumes.hpp"
#include "riffler/dexel/boolean.hpp"
#include "riffler/marching/to_mesh.hpp"
#include "riffler/mesh/audit.hpp"
#include "support/effort.hpp"
#include "support/error_of.hpp"

namespace riffler::dexel::smooth_dabs_test {
namespace {

using test::expect_sound;
using test::for_each_end;
using test::HalfSpace;

SmoothResult dab(Volume& volume, const Vec3& centre, double radius, double strength = 1) {
  SmoothOptions options;
  options.radius = radius, options.strength = strength;
  return smooth_dabs(volume, std::vector<Vec3>{centre}, options);
}

/// Tiles of `a` that are not those of `b`.
std::size_t other_tiles(const Volume& a, const Volume& b) {
  std::size_t n = 0;
  for (std::size_t g = 0; g < a.grids().size(); ++g)
    for (std::size_t t = 0; t < a.grids()[g].tile_count(); ++t)
      n += a.grids()[g].shared_tile(t) != b.grids()[g].shared_tile(t);
  return n;
}

TEST(Soften, LeavesPlanesOfAnyTiltUnchangedAlsoFarFromTheOrigin) {
  std::mt19937 random(5);
  std::normal_distribution<double> d;
  for (const Vec3& origin : {Vec3(0), Vec3(1e5, -1e5, 1e5)})
    for (int k = 0; k < 12; ++k) {
      const Vec3 normal = k == 0 ? Vec3(0, 0, 1) : k == 1 ? Vec3(1, 0, 1e-3) : Vec3(d(random), d(random), d(random));
      const Frame frame{{origin, origin + Vec3(12)}, 0.25, "xyz"};
      const Vec3 centre = origin + Vec3(6.03, 5.9, 6.1);
      const HalfSpace half = HalfSpace::at(centre, normal);
      const Volume before = test::convex(frame, {half});
      Volume volume = before;
      dab(volume, centre, 2.5);
      for (std::size_t g = 0; g < 3; ++g)
        for (std::size_t t = 0; t < before.grids()[g].tile_count(); ++t)
          EXPECT_EQ(volume.grids()[g].tile(t).spans.size(), before.grids()[g].tile(t).spans.size());
      double farthest = 0;
      for_each_end(volume, [&](const Vec3& p, const Vec3&) {
        if (glm::distance(p, centre) < 5) farthest = std::max(farthest, std::abs(glm::dot(half.normal, p - centre)));
      });
      EXPECT_LT(farthest, 1e-9) << "plane " << k << " at " << origin.x;
    }
}

TEST(Soften, ShrinksASphereAtTheRateOfItsKernelAndKeepsItRound) {
  constexpr double h = 0.4, radius = 10, reach = 4 * h;
  const Vec3 centre{0.03, -0.05, 0.02};
  // A place whose neighbours lie d²/2R lower, in the mean over the kernel (1 − d²/ρ²)³ on the plane that touches it.
  double weights = 0, drop = 0;
  for (double d = 0.0005 * reach; d < reach; d += 0.001 * reach) {
    const double w = std::pow(1 - d * d / reach / reach, 3) * d;
    weights += w, drop += w * d * d / (2 * radius);
  }
  Volume volume = test::ball({{Vec3(-11), Vec3(11)}, h, "xyz"}, centre, radius);
  for (int dabs = 1; dabs <= 3; ++dabs) {
    const double expected = dabs * drop / weights;
    dab(volume, centre, 1e4);
    double sum = 0, least = 1e300, most = 0;
    std::size_t n = 0;
    for_each_end(volume, [&](const Vec3& p, const Vec3& normal) {
      const double r = glm::distance(p, centre);
      sum += r, ++n, least = std::min(least, r), most = std::max(most, r);
      ASSERT_GT(glm::dot(normal, p - centre), 0.99 * r);
    });
    EXPECT_NEAR((radius - sum / static_cast<double>(n)) / expected, 1, 0.1);
    EXPECT_LT(most - least, 0.03 * h);
  }
  expect_sound(volume);
}

/// RMS of the z ends' heights over `level` within `radius` of the middle.
double roughness(const Volume& volume, double level, double radius) {
  const Grid& grid = *volume.grid(Axis::Z);
  const Vec3 middle = 0.5 * (volume.frame().box.lower + volume.frame().box.upper);
  double sum = 0;
  int n = 0;
  for (int i = 0; i < grid.nu(); ++i)
    for (int j = 0; j < grid.nv(); ++j) {
      if (std::hypot(grid.u(i) - middle.x, grid.v(j) - middle.y) > radius || grid.ray(i, j).empty()) continue;
      const double off = grid.ray(i, j).back().far - level;
      sum += off * off, ++n;
    }
  return std::sqrt(sum / n);
}

TEST(Soften, MoreThanHalvesNoiseInOneDab) {
  constexpr double h = 0.25, level = 6;
  const Frame frame{{{0, 0, 0}, {16, 16, 10}}, h, "xyz"};
  Volume volume = test::convex(frame, {HalfSpace::at({0, 0, level}, {0, 0, 1})});
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 0.5 * h);
  Grid& grid = volume.grids()[2];
  for (std::size_t t = 0; t < grid.tile_count(); ++t)
    grid.fill_tile(t, [&](int, int, TileBuilder& builder) {
      builder.add({0, level + noise(random)}, {PackedNormal::pack({0, 0, -1}), PackedNormal::pack({0, 0, 1})});
    });
  const double before = roughness(volume, level, 3);
  const Volume rough = volume;
  const SmoothResult once = dab(volume, {8, 8, level}, 5);
  EXPECT_LT(roughness(volume, level, 3), 0.5 * before);
  EXPECT_GT(once.removed[0], 0);
  EXPECT_GT(once.added[0], 0);
  EXPECT_NEAR(once.added[0] - once.removed[0], volume.volume() - rough.volume(), 1e-9);
  expect_sound(volume);
  Volume weakly = rough;
  dab(weakly, {8, 8, level}, 5, 0.2);
  EXPECT_GT(roughness(weakly, level, 3), 0.6 * before);
  EXPECT_LT(roughness(weakly, level, 3), 0.95 * before);
}

TEST(Soften, RoundsAnEdgeAlikeOnBothSides) {
  constexpr double h = 0.25;
  Volume volume = Volume::block({{{0, 0, 0}, {16, 10, 10}}, h, "xyz"});
  for (int k = 0; k < 3; ++k) {
    const SmoothResult s = dab(volume, {8, 0, 0}, 4);
    EXPECT_GT(s.removed[0], 0);
    EXPECT_LT(s.added[0], 0.1 * s.removed[0]);
  }
  // z rays of row j end near the edge as high as y rays of the plane k = j end far from it.
  const Grid &z = *volume.grid(Axis::Z), &y = *volume.grid(Axis::Y);
  double most = 0;
  for (int i = 20; i < 44; ++i)
    for (int j = 0; j < 12; ++j) {
      const auto up = z.ray(i, j), across = y.ray(j, i);
      ASSERT_EQ(up.empty(), across.empty());
      if (up.empty()) continue;
      EXPECT_NEAR(up[0].near, across[0].near, 0.02 * h);
      most = std::max(most, up[0].near);
    }
  EXPECT_GT(most, 0.7 * h);
  expect_sound(volume);
}

TEST(Soften, MovesNothingByMoreThanAPitchAndNothingBeyondItsRadius) {
  constexpr double h = 0.5, radius = 4;
  const Frame frame{{Vec3(0), Vec3(24)}, h, "xyz"};
  const Vec3 tip{12, 12, 18};
  // a wedge of 60°, a corner, a needle four pitches wide, a wall three pitches thick
  const std::vector<std::vector<HalfSpace>> shapes{
      {HalfSpace::at(tip, {std::sqrt(3), 0.1, 1}), HalfSpace::at(tip, {-std::sqrt(3), 0, 1})},
      {HalfSpace::at(tip, {1, 0.2, 0}), HalfSpace::at(tip, {0, 1, -0.1}), HalfSpace::at(tip, {0.1, 0, 1})},
      {HalfSpace::at(tip, {1, 0.1, 0}), HalfSpace::at(tip - Vec3(2, 0, 0), {-1, -0.1, 0}),
       HalfSpace::at(tip, {0, 1, 0}), HalfSpace::at(tip - Vec3(0, 2, 0), {0, -1, 0}), HalfSpace::at(tip, {0, 0, 1})},
      {HalfSpace::at(tip, {1, 0.1, 0.05}), HalfSpace::at(tip - Vec3(1.5, 0, 0), {-1, -0.1, -0.05}),
       HalfSpace::at(tip, {0, 0, 1})}};
  for (const std::vector<HalfSpace>& sides : shapes) {
    Volume volume = test::convex(frame, sides);
    const Volume before = volume;
    const SmoothResult s = dab(volume, tip, radius);
    EXPECT_GT(s.removed[0], 0);
    EXPECT_LT(s.removed[0], 100);
    expect_sound(volume);
    for_each_end(volume, [&](const Vec3& p, const Vec3&) {
      double depth = 1e300;  // below the solid that was, which is convex
      for (const HalfSpace& side : sides) depth = std::min(depth, side.offset - glm::dot(side.normal, p));
      for (int k = 0; k < 3; ++k) depth = std::min({depth, p[k], 24 - p[k]});
      EXPECT_LT(depth, 1.05 * h) << p.x << " " << p.y << " " << p.z;
      EXPECT_GT(depth, -0.1 * h) << p.x << " " << p.y << " " << p.z;
      if (glm::distance(p, tip) > radius + 1.5 * h) {
        EXPECT_NEAR(depth, 0, 1e-9);
      }
    });
  }
}

TEST(Soften, KeepsBothSidesOfAWallThinnerThanItsReach) {
  for (const double thickness : {0.25, 0.1, 0.6}) {  // of pitch 0.25
    const Frame frame{{Vec3(0), Vec3(12)}, 0.25, "xyz"};
    const Vec3 place{6.05, 6, 6}, normal = glm::normalize(Vec3(1, 0.2, 0.3));
    const HalfSpace front = HalfSpace::at(place, normal), back = HalfSpace::at(place - thickness * normal, -normal);
    const Volume wall = test::convex(frame, {front, back});
    Volume volume = wall;
    const SmoothResult s = dab(volume, place, 2.5);
    EXPECT_LT(s.removed[0] + s.added[0], 1e-9);
    // a gap as narrow as that
    Volume gap = Volume::block(frame);
    apply(Boolean::Subtract, gap, wall);
    const SmoothResult g = dab(gap, place, 2.5);
    EXPECT_LT(g.removed[0] + g.added[0], 1e-9);
  }
}

TEST(Soften, WearsOffTheRimOfAThinWallAndLeavesNoCrumbs) {
  const Frame frame{{Vec3(0), Vec3(12)}, 0.25, "xyz"};
  Volume wall = test::convex(frame, {HalfSpace::at({6.3, 0, 0}, {1, 0, 0}), HalfSpace::at({5.7, 0, 0}, {-1, 0, 0}),
                                     HalfSpace::at({0, 0, 11}, {0, 0, 1})});
  for (int k = 0; k < 12; ++k) {
    const SmoothResult s = dab(wall, {6, 0, 11}, 3);
    EXPECT_GT(s.removed[0], 0.05);
    EXPECT_LT(s.added[0], 1e-3);
    expect_sound(wall);
    EXPECT_EQ(audit(marching::to_mesh(wall)).components, 1U) << "dab " << k;
  }
}

TEST(Soften, AcceptsAnyPlaceAndSizeOfTheBrush) {
  const Frame frame{{{0, 0, 0}, {20, 17, 9}}, 0.5, "xyz"};
  const Volume block = Volume::block(frame);
  Volume empty(frame);
  dab(empty, {3, 3, 3}, 5);
  EXPECT_EQ(empty.volume(), 0);
  for (const Vec3& centre : {Vec3(0, 0, 0), Vec3(20, 17, 9), Vec3(10, 17, 9), Vec3(10, 8, 4), Vec3(10, 8, 12)})
    for (const double radius : {1e-3, 0.4, 3.0, 1e6}) {
      Volume volume = block;
      const SmoothResult s = dab(volume, centre, radius);
      EXPECT_EQ(s.added[0], 0);
      EXPECT_NEAR(block.volume() - volume.volume(), s.removed[0], 1e-9);
      expect_sound(volume);
    }
  Volume volume = block;
  const SmoothResult far = dab(volume, {-30, 5, 5}, 8);
  EXPECT_EQ(far.removed[0], 0);
  EXPECT_EQ(other_tiles(volume, block), 0U);
  EXPECT_EQ(volume.revision(), block.revision());
}

TEST(Soften, DoesNothingWithoutStrengthNorOnAPlane) {
  const Frame frame = test::lattice_frame("xyz");
  const Volume before = test::random_volume(frame, 4);
  Volume volume = before;
  const SmoothResult s = dab(volume, {12, 12, 12}, 8, 0);
  EXPECT_EQ(s.removed, std::vector<double>{0});
  EXPECT_EQ(other_tiles(volume, before), 0U);
  EXPECT_EQ(volume.revision(), before.revision());

  const Volume block = Volume::block({{{0, 0, 0}, {60, 60, 20}}, 0.5, "xyz"});
  volume = block;
  dab(volume, {30, 30, 20}, 10);
  const Stats flat = volume.take_stats();
  EXPECT_EQ(flat.tiles_visited + flat.rays_tested + flat.tiles_changed, 0U);
  EXPECT_EQ(other_tiles(volume, block), 0U);
  EXPECT_EQ(volume.revision(), block.revision());
}

TEST(Soften, ChangesTilesUnderTheBrushOnlyHoweverLargeTheVolume) {
  Stats of[2];
  for (int k = 0; k < 2; ++k) {
    const Volume block = Volume::block({{{0, 0, 0}, {k ? 120.0 : 60.0, k ? 100.0 : 50.0, 40}}, 0.5, "xyz"});
    Volume volume = block;
    dab(volume, {20, 0, 0}, 4);
    of[k] = volume.take_stats();
    EXPECT_EQ(other_tiles(volume, block), of[k].tiles_changed);
    EXPECT_NE(volume.revision(), block.revision());
  }
  EXPECT_EQ(of[0].moves, 1U);
  EXPECT_GT(of[0].rays_changed, 50U);
  EXPECT_LE(of[0].tiles_visited, 8U);
  EXPECT_EQ(of[0].rays_tested, of[1].rays_tested);
  EXPECT_EQ(of[0].rays_changed, of[1].rays_changed);
  EXPECT_EQ(of[0].hits, of[1].hits);
  EXPECT_EQ(of[0].tiles_changed, of[1].tiles_changed);
}

TEST(Soften, KeepsProtectedMaterialToTheBit) {
  const Frame frame{{Vec3(0), Vec3(20)}, 0.5, "xyz"};
  const Volume kept = test::convex(frame, {HalfSpace::at({10, 0, 0}, {1, 0, 0.1})});
  for (const bool random : {false, true}) {
    const Volume before = random ? test::random_volume(test::lattice_frame("xyz"), 2) : Volume::block(frame);
    const Volume mask = random ? test::random_volume(test::lattice_frame("xyz"), 3) : kept;
    Volume volume = before, freely = before;
    SmoothOptions options;
    options.radius = random ? 3 : 6, options.strength = 1, options.protect = &mask;
    const std::vector<Vec3> centres{{10, 20, 20}, {10, 19, 20}};
    const SmoothResult s = smooth_dabs(volume, centres, options);
    options.protect = nullptr;
    const SmoothResult t = smooth_dabs(freely, centres, options);
    EXPECT_GT(s.removed[0], 0);
    EXPECT_LT(s.removed[0], t.removed[0]);
    EXPECT_NEAR(s.added[0] + s.added[1] - s.removed[0] - s.removed[1], volume.volume() - before.volume(), 1e-8);
    Volume inside = volume, was = before;
    apply(Boolean::Intersect, inside, mask), apply(Boolean::Intersect, was, mask);
    EXPECT_TRUE(test::same_spans(inside, was));
    expect_sound(volume);
  }
}

TEST(Soften, LeavesRandomVolumesValid) {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> place(-2, 26), size(0.2, 5), share(0, 1);
  for (int seed = 0; seed < test::cases(12, 3); ++seed) {
    const double pitch = seed % 3 == 0 ? 0.55 : seed % 3 == 1 ? 0.7 : 1;
    const Frame frame = test::lattice_frame("xyz", pitch);
    Volume volume = seed % 4 == 3 ? test::wavy_volume(frame) : test::random_volume(frame, static_cast<unsigned>(seed));
    for (int k = 0; k < 4; ++k) dab(volume, {place(random), place(random), place(random)}, size(random), share(random));
    expect_sound(volume);
    EXPECT_FALSE(::testing::Test::HasFailure()) << "seed " << seed;
  }
}

TEST(Soften, GivesTheSameBytesForAnyNumberOfThreads) {
  std::vector<Volume> volumes;
  for (const char* threads : {"1", "2", "4"}) {
    setenv("RIFFLER_THREADS", threads, 1);
    Volume volume = test::random_volume(test::lattice_frame("xyz"), 9);
    SmoothOptions options;
    options.radius = 2.5, options.strength = 0.8;
    smooth_dabs(volume, std::vector<Vec3>{{8, 9, 10}, {10, 9, 10}, {10, 11, 12}}, options);
    volumes.push_back(std::move(volume));
  }
  unsetenv("RIFFLER_THREADS");
  EXPECT_TRUE(test::same_rays(volumes[0], volumes[1]));
  EXPECT_TRUE(test::same_rays(volumes[0], volumes[2]));
}

TEST(Soften, ChangesNothingWhenCancelled) {
  const Volume before = Volume::block(test::lattice_frame("xyz"));
  for (const int calls : {0, 1, 3, 7}) {
    Volume volume = before;
    int left = calls;
    SmoothOptions options;
    options.progress = [&](double share) {
      EXPECT_TRUE(share >= 0 && share <= 1);
      return left-- > 0;
    };
    EXPECT_THROW(smooth_dabs(volume, std::vector<Vec3>{{0, 0, 0}, {24, 0, 0}, {24, 24, 0}}, options), Cancelled);
    EXPECT_EQ(other_tiles(volume, before), 0U);
    EXPECT_EQ(volume.revision(), before.revision());
    EXPECT_EQ(volume.take_stats().moves, 0U);
  }
}

TEST(Soften, NamesBadInput) {
  Volume volume = Volume::block(test::lattice_frame("xyz")), one = Volume::block(test::lattice_frame("z"));
  const Volume coarse = Volume::block(test::lattice_frame("xyz", 1));
  const auto error = [](Volume& v, const std::vector<Vec3>& centres, double radius, double strength,
                        const Volume* protect) {
    SmoothOptions options;
    options.radius = radius, options.strength = strength, options.protect = protect;
    return test::error_of([&] { smooth_dabs(v, centres, options); });
  };
  const double nan = std::nan("");
  EXPECT_EQ(error(one, {{0, 0, 0}}, 5, 1, nullptr),
            "soften needs a volume of directions \"xyz\", whose ends have normals; this one has \"z\"");
  EXPECT_EQ(error(volume, {{0, 0, 0}, {0, nan, 0}}, 5, 1, nullptr), "centres, row 1: not finite");
  for (const double radius : {0.0, -1.0, nan, 1 / 0.0})
    EXPECT_EQ(error(volume, {}, radius, 1, nullptr), "radius must be a positive length in mm");
  for (const double strength : {-0.1, 1.5, nan})
    EXPECT_EQ(error(volume, {}, 5, strength, nullptr), "strength must be from 0 to 1");
  EXPECT_EQ(error(volume, {}, 5, 1, &coarse), "protect must have the same grid as the volume, but its pitch differs");
}

}  // namespace
}  // namespace riffler::dexel::smooth_dabs_test
