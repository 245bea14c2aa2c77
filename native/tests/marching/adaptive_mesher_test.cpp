// A mesher with a tolerance: after any changes it has the bytes of a new one and of to_mesh.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "riffler/base/parallel.hpp"
#include "riffler/marching/mesher.hpp"
#include "riffler/marching/to_mesh.hpp"
#include "riffler/sweep/carve.hpp"
#include "riffler/tool/cutters.hpp"
#include "stress/float_audit.hpp"
#include "stress/mesh_checks.hpp"
#include "stress/mesh_scenes.hpp"
#include "support/effort.hpp"
#include "tests/marching/followed.hpp"

namespace riffler::marching::adaptive_mesher_test {
namespace {

using namespace stress;
using namespace mesher_test;

TEST(AdaptiveMesher, FollowsACarvedBlock) {
  for (const char* directions : {"xyz", "z", "x"})
    for (const double tolerance : {0.004, 0.05}) {
      if (test::kSanitized && *directions == 'z') continue;
      Volume volume = Volume::block({{{0, 0, 0}, {30, 24, 21}}, 0.25, directions});
      Mesher mesher(volume, tolerance);
      EXPECT_TRUE(float_audit(mesher.mesh()).clean());
      EXPECT_LT(mesher.triangles(), 2000U);
      Patches patches(mesher);
      Random random(7);
      for (int stroke = 0; stroke < test::cases(8); ++stroke) {
        carve_at_random(volume, stroke, random);
        const std::vector<std::size_t> changed = mesher.update(volume);
        const std::string what =
            std::string(directions) + ", " + std::to_string(tolerance) + ", stroke " + std::to_string(stroke);
        const Mesh whole = to_mesh(volume, tolerance);
        expect_mesh(mesher, whole, what);
        EXPECT_EQ(mesher.triangles(), whole.triangles.size()) << what;
        patches.update(mesher, changed);
        if (stroke % 4 == 3) {
          patches.expect_same(whole, what);
          EXPECT_TRUE(float_audit(whole).clean()) << what;
          expect_mesh(Mesher(volume, tolerance), whole, what + ", a new mesher");
        }
        EXPECT_LT(changed.size(), 48U) << what;  // of 64 with triangles
        if (HasFailure()) return;
      }
    }
}

/// Rays that contradict each other: folds across the borders of groups, so several layers of fixed vertices.
TEST(AdaptiveMesher, FollowsGridsThatContradictEachOther) {
  for (unsigned seed = 0; seed < 8; ++seed) {
    if (test::kSanitized && seed != 3) continue;
    Random random(300 + seed);
    const double h = 0.25, offset = seed % 4 == 3 ? 4e5 : 0;
    const Vec3 lower(offset, 0, -offset);
    const Vec3 size = seed % 2 ? Vec3(random.uniform(9, 15), random.uniform(6, 12), random.uniform(6, 12))
                               : Vec3(random.uniform(30, 36), random.uniform(4, 6), random.uniform(4, 6));
    Volume volume({{lower, lower + size}, h, seed % 3 ? "xyz" : "z"});
    const double share = random.one_in(2) ? random.uniform(0, 0.1) : random.uniform(0, 1);
    const Solid base = turned_box(lower + size / 2.0, size * 0.4, random_turn(random));
    fill(volume, [&](const dexel::Grid& grid, int i, int j) {
      if (random.uniform() >= share) {
        const Vec3 p = to_world(grid.axis(), Vec3(grid.u(i), grid.v(j), 0));
        return meet(base, box(lower, lower + size))(p, to_world(grid.axis(), Vec3(0, 0, 1)));
      }
      return spans_at_random(random, grid, 0.8, true);
    });
    const double tolerance = std::array{0.04, 0.1, 0.3, 2.0}[seed / 2];
    Mesher mesher(volume, tolerance);
    Patches patches(mesher);
    const std::string what = "seed " + std::to_string(seed);
    for (int step = 0; step < test::cases(3); ++step) {
      dexel::Grid& grid =
          volume.grids()[static_cast<std::size_t>(random.below(static_cast<int>(volume.grids().size())))];
      const int i0 = random.below(grid.nu()), j0 = random.below(grid.nv());
      const int i1 = std::min(grid.nu() - 1, i0 + random.below(13)),
                j1 = std::min(grid.nv() - 1, j0 + random.below(13));
      change_rays(grid, i0, i1, j0, j1, [&] { return spans_at_random(random, grid, 0.8, true); });
      volume.touch();
      patches.update(mesher, mesher.update(volume));
      const Mesh whole = to_mesh(volume, tolerance);
      expect_mesh(mesher, whole, what + ", step " + std::to_string(step));
      patches.expect_same(whole, what + ", step " + std::to_string(step));
      const FloatAudit audit = float_audit(whole);
      EXPECT_TRUE(audit.clean()) << what << ": " << audit;
      if (HasFailure()) return;
    }
  }
}

/// to_mesh leaves out the inside of flat bricks, and makes it where folds of contradicting rays are pulled next to
/// them; a mesher has it.
TEST(AdaptiveMesher, HasTheBytesOfAMeshThatWasMadePartly) {
  for (unsigned seed = 0; seed < (test::kSanitized ? 1 : 2); ++seed) {
    Random random(500 + seed);
    const Volume block = Volume::block({{{0, 0, 0}, {44, 44, 12}}, 0.25, seed % 3 ? "xyz" : "z"});
    Volume volume = block;
    Mesher mesher(volume, 0.05);
    for (int step = 0; step < 2; ++step) {
      // A patch across the border of two bricks, 32 rays long.
      for (dexel::Grid& grid : volume.grids()) {
        const int i = random.below(grid.nu() - 8), j = 32 * random.below(grid.nv() / 32) + 24;
        change_rays(grid, i, i + 6, std::min(j, grid.nv() - 8), std::min(j + 7, grid.nv() - 1),
                    [&] { return spans_at_random(random, grid, 0.8, true); });
      }
      volume.touch();
      mesher.update(volume);
      const std::string what = "seed " + std::to_string(seed) + ", step " + std::to_string(step);
      const Mesh whole = to_mesh(volume, 0.05);
      expect_mesh(mesher, whole, what);
      EXPECT_EQ(check_within(whole, to_mesh(volume), 0.05), "") << what;
      if (HasFailure()) return;
    }
    mesher.update(block);
    expect_mesh(mesher, to_mesh(block, 0.05), "back");
  }
}

TEST(AdaptiveMesher, HasTheSameBytesForAnyNumberOfThreads) {
  std::vector<Mesh> meshes;
  for (const int threads : {1, 2, 5}) {
    base::set_thread_count(threads);
    Volume volume = Volume::block({{{0, 0, 0}, {30, 24, 21}}, 0.25, "xyz"});
    Random random(11);
    Mesher mesher(volume, 0.01);
    for (int stroke = 0; stroke < 6; ++stroke) {
      carve_at_random(volume, stroke, random);
      mesher.update(volume);
    }
    meshes.push_back(mesher.mesh());
    EXPECT_EQ(meshes.back().vertices, meshes.front().vertices) << threads;
    EXPECT_EQ(meshes.back().triangles, meshes.front().triangles) << threads;
  }
  base::set_thread_count(std::nullopt);
}

TEST(AdaptiveMesher, UpdatesOnlyNearAChange) {
  Volume volume = Volume::block({{{0, 0, 0}, {80, 80, 9}}, 0.25, "xyz"});
  Mesher mesher(volume, 0.01);
  sweep::carve(volume, cutters::ball(2, 40),
               std::array{Pose{{36, 36, 8.5}, {0, 0, 1}}, Pose{{37, 36, 8.5}, {0, 0, 1}}});
  const std::vector<std::size_t> changed = mesher.update(volume);
  EXPECT_GE(changed.size(), 1U);
  // One brick was cut; what its borders share with the next ones may change, and nothing beyond.
  const Vec3i shape = mesher.shape();
  for (const std::size_t n : changed) {
    const auto row = static_cast<int>(n) / shape.z;
    EXPECT_LE(std::abs(row / shape.y - 4), 2);
    EXPECT_LE(std::abs(row % shape.y - 4), 2);
  }
  EXPECT_TRUE(mesher.update(volume).empty());
}

TEST(AdaptiveMesher, FollowsAVolumeThatBecomesEmptyAndBack) {
  const Volume block = Volume::block({{{0, 0, 0}, {20, 20, 20}}, 0.5, "xyz"});
  Mesher mesher(block, 0.05);
  const std::vector<std::size_t> all = mesher.patches();
  const Volume nothing(block.frame());
  EXPECT_EQ(mesher.update(nothing), all);
  EXPECT_TRUE(mesher.mesh().empty());
  EXPECT_TRUE(mesher.patches().empty());
  EXPECT_EQ(mesher.triangles(), 0U);
  mesher.update(block);
  EXPECT_EQ(mesher.patches(), all);
  expect_mesh(mesher, to_mesh(block, 0.05), "back");
}

TEST(AdaptiveMesher, WithoutAUsableToleranceHasTheFullMeshOrThrows) {
  Volume volume = Volume::block({{{0, 0, 0}, {20, 20, 10}}, 0.5, "xyz"});
  for (const double tolerance : {0.0, 1e-7}) {
    Mesher mesher(volume, tolerance);
    expect_mesh(mesher, to_mesh(volume), "not used");
  }
  expect_mesh(Mesher(volume, 1000), to_mesh(volume, 1000), "larger than the part");
  for (const double bad :
       {-1e-9, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    EXPECT_THROW(Mesher(volume, bad), std::invalid_argument) << bad;
}

/// Large triangles of flat ground are shaded flat next to a groove whose walls are too shallow for a sharp edge; the
/// full mesh bends the light on a cell.
TEST(AdaptiveMesher, ShadesFlatGroundFlatNextToShallowGrooves) {
  Volume volume = Volume::block({{{-20, -20, -4}, {20, 20, 4}}, 0.25, "xyz"});
  for (int k = 0; k < 4; ++k) {
    std::vector<Pose> poses;
    for (int n = 0; n <= 40; ++n)
      poses.push_back({{-15 + 0.75 * n, -14 + 9 * k + 1.5 * std::sin(0.2 * n + k), 4 - 0.1 * (k + 1)}, {0, 0, 1}});
    sweep::carve(volume, cutters::ball(6, 60), poses);
  }
  const Mesher mesher(volume, 0.025);
  const MeshPatch patch = mesher.patch(mesher.patches());
  const base::BulkVector<Vec3f> normals = mesher.corner_normals(patch, 0.35);
  double flat = 0, bent = 0;
  for (std::size_t t = 0; t < patch.triangles.size(); ++t) {
    const auto place = [&](int c) { return Vec3(patch.vertices[patch.triangles[t][c]]); };
    if (std::min({place(0).z, place(1).z, place(2).z}) < 4 - 1e-5) continue;
    const double area = 0.5 * glm::length(glm::cross(place(1) - place(0), place(2) - place(0)));
    flat += area;
    for (int c = 0; c < 3; ++c)
      if (normals[3 * t + c].z < std::cos(0.01F)) {
        bent += area;
        break;
      }
  }
  EXPECT_GT(flat, 500);
  EXPECT_LT(bent, 0.005 * flat);
}

/// A corner's normal is that of the full mesh there, not of the long triangles.
TEST(AdaptiveMesher, HasTheNormalsOfTheFullMesh) {
  Volume volume = Volume::block({{{0, 0, 0}, {24, 24, 12}}, 0.25, "xyz"});
  const Vec3 centre(12, 12, 18);
  const double radius = 12;
  sweep::carve(volume, cutters::ball(2 * radius, 60),
               std::array{Pose{centre - Vec3(0, 0, radius), {0, 0, 1}}, Pose{centre - Vec3(0, 0, radius), {0, 0, 1}}});
  const Mesher mesher(volume, 0.05);
  const std::vector<std::size_t> bricks = mesher.patches();
  std::size_t on_ball = 0;
  for (const bool one_by_one : {false, true}) {
    std::vector<MeshPatch> patches;
    if (one_by_one)
      for (const std::size_t n : bricks) patches.push_back(mesher.patch(n));
    else
      patches.push_back(mesher.patch(bricks));
    for (const MeshPatch& patch : patches) {
      const base::BulkVector<Vec3f> normals = mesher.corner_normals(patch, 0.5);
      ASSERT_EQ(normals.size(), 3 * patch.triangles.size());
      for (std::size_t t = 0; t < patch.triangles.size(); ++t) {
        const auto place = [&](int c) { return Vec3(patch.vertices[patch.triangles[t][c]]); };
        const auto inside = [&](const Vec3& p) {
          return p.z < 11.5 && std::abs(glm::length(p - centre) - radius) < 1e-3;
        };
        for (int c = 0; c < 3; ++c) {
          EXPECT_NEAR(glm::length(normals[3 * t + c]), 1, 1e-5);
          if (!inside(place(0)) || !inside(place(1)) || !inside(place(2))) continue;
          const Vec3 expected = (centre - place(c)) / radius;
          EXPECT_GT(glm::dot(Vec3(normals[3 * t + c]), expected), std::cos(0.03)) << place(c).x;
          ++on_ball;
        }
      }
    }
  }
  EXPECT_GT(on_ball, 200U);
}

}  // namespace
}  // namespace riffler::marching::adaptive_mesher_test
