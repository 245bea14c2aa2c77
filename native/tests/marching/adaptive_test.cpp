// to_mesh with a tolerance: judged by an audit and a distance of their own, which share no code with the mesher.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "bench/mesh_distance.hpp"
#include "riffler/base/parallel.hpp"
#include "riffler/marching/to_mesh.hpp"
#include "riffler/sweep/carve.hpp"
#include "riffler/tool/cutters.hpp"
#include "stress/float_audit.hpp"
#include "stress/mesh_scenes.hpp"
#include "support/effort.hpp"

namespace riffler::marching::adaptive_test {
namespace {

using stress::Random;

bool same(const Mesh& a, const Mesh& b) {
  return a.vertices == b.vertices && a.triangles == b.triangles;
}

/// The largest distance of sampled points of one mesh from another.
double farthest(const Mesh& of, const Mesh& from, Random& random) {
  const bench::MeshDistance distance(from);
  double worst = 0;
  for (const Vec3i& t : of.triangles) {
    const Vec3 &a = of.vertices[t.x], &b = of.vertices[t.y], &c = of.vertices[t.z];
    const auto look = [&](double x, double y) { worst = std::max(worst, distance(a + x * (b - a) + y * (c - a))); };
    look(0, 0), look(0.5, 0), look(0.5, 0.5), look(0, 0.5), look(1.0 / 3, 1.0 / 3);
    // Long triangles get more points.
    const double longest = std::max({glm::length(b - a), glm::length(c - a), glm::length(c - b)});
    const double scale = std::sqrt(static_cast<double>(from.triangles.size()));
    const int more = static_cast<int>(std::min(40.0, 4 * longest / (longest + 1) + scale / 4));
    for (int n = 0; n < more; ++n) {
      double x = random.uniform(0, 1), y = random.uniform(0, 1);
      if (x + y > 1) x = 1 - x, y = 1 - y;
      look(x, y);
    }
  }
  return worst;
}

/// Everything that a tolerance promises.
void expect_kept(const Volume& volume, double tolerance, Random& random, const std::string& what) {
  const Mesh full = to_mesh(volume), mesh = to_mesh(volume, tolerance);
  ASSERT_EQ(mesh.empty(), full.empty()) << what;
  if (full.empty()) return;
  EXPECT_LE(mesh.triangles.size(), full.triangles.size()) << what;
  stress::FloatAudit audit = stress::float_audit(mesh);
  EXPECT_TRUE(audit.clean()) << what << ": " << audit;
  // Some places of far boxes are coarser than the tolerance; the distances are exact to a few ulps of them.
  const Box3 box = stress::box_of(full);
  const double ulps = 1e-14 * std::max({std::abs(box.lower.x), std::abs(box.lower.y), std::abs(box.lower.z),
                                        std::abs(box.upper.x), std::abs(box.upper.y), std::abs(box.upper.z), 1.0});
  EXPECT_LE(farthest(mesh, full, random), tolerance + ulps) << what;
  EXPECT_LE(farthest(full, mesh, random), tolerance + ulps) << what;
  double area = 0;
  for (const Vec3i& t : full.triangles)
    area +=
        0.5 * glm::length(glm::cross(full.vertices[t.y] - full.vertices[t.x], full.vertices[t.z] - full.vertices[t.x]));
  // Each point moves by at most the tolerance.
  EXPECT_NEAR(stress::enclosed(mesh), stress::enclosed(full), area * tolerance * (1 + 1e-6) + 1e-9 * area) << what;
}

Volume grooved(double pitch, const char* directions) {
  Volume volume = Volume::block({{{0, 0, 0}, {24, 18, 9}}, pitch, directions});
  const std::array moves{Pose{{3, 4, 7.5}, {0, 0, 1}}, Pose{{20, 11, 7}, {0, 0, 1}},
                         Pose{{8, 15, 6.5}, glm::normalize(Vec3(0.3, 0, 1))}};
  sweep::carve(volume, cutters::ball(5, 40), moves);
  return volume;
}

TEST(AdaptiveMesh, IsClosedAndWithinToleranceForAnyVolume) {
  Random random(32);
  for (int scene = 0; scene < static_cast<int>(stress::MeshScene::kCount); ++scene)
    for (int n = 0; n < test::cases(30); ++n) {
      const Volume volume = stress::draw_volume(random, static_cast<stress::MeshScene>(scene));
      const double share = std::array{0.02, 0.1, 0.5, 3.0, 1000.0}[n % 5];
      expect_kept(volume, share * volume.frame().pitch, random,
                  std::string(stress::name(static_cast<stress::MeshScene>(scene))) + " " + std::to_string(n));
      if (HasFailure()) return;
    }
}

TEST(AdaptiveMesh, OfACarvedBlockNeedsFewTriangles) {
  Random random(5);
  for (const char* directions : {"xyz", "z", "y"})
    for (const double tolerance : {0.0005, 0.01, 0.1}) {
      if (test::kSanitized && tolerance != 0.01) continue;
      const Volume volume = grooved(0.25, directions);
      expect_kept(volume, tolerance, random, directions + std::to_string(tolerance));
    }
  const Volume fine = grooved(0.1, "xyz");
  const std::size_t full = to_mesh(fine).triangles.size();
  EXPECT_LT(30 * to_mesh(fine, 0.005).triangles.size(), full);
  EXPECT_LT(60 * to_mesh(fine, 0.02).triangles.size(), full);
}

TEST(AdaptiveMesh, KeepsTheEdgesAndCornersOfABlock) {
  for (const double pitch : {0.5, 0.1}) {
    const Volume volume = Volume::block({{{0, 0, 0}, {20, 13, 9}}, pitch, "xyz"});
    const Mesh full = to_mesh(volume), mesh = to_mesh(volume, 0.2 * pitch);
    EXPECT_EQ(stress::box_of(mesh).lower, stress::box_of(full).lower);
    EXPECT_EQ(stress::box_of(mesh).upper, stress::box_of(full).upper);
    EXPECT_NEAR(stress::enclosed(mesh), stress::enclosed(full), 1e-2 * pitch);
    // Each triangle lies in a face of the block.
    for (const Vec3i& t : mesh.triangles) {
      const Vec3 n =
          glm::normalize(glm::cross(mesh.vertices[t.y] - mesh.vertices[t.x], mesh.vertices[t.z] - mesh.vertices[t.x]));
      EXPECT_GT(std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)}), 0.999);
    }
  }
}

TEST(AdaptiveMesh, HasTheSameBytesForAnyNumberOfThreads) {
  for (const char* directions : {"xyz", "z"}) {
    const Volume volume = grooved(test::kSanitized ? 0.25 : 0.1, directions);
    base::set_thread_count(1);
    const Mesh one = to_mesh(volume, 0.01);
    for (const int threads : {2, 5}) {
      base::set_thread_count(threads);
      EXPECT_TRUE(same(to_mesh(volume, 0.01), one)) << directions << ", " << threads << " threads";
    }
    base::set_thread_count(std::nullopt);
  }
}

TEST(AdaptiveMesh, WithoutAUsableToleranceIsTheFullMeshOrAnError) {
  const Volume volume = grooved(0.25, "xyz");
  const Mesh full = to_mesh(volume);
  EXPECT_TRUE(same(to_mesh(volume, 0), full));
  EXPECT_TRUE(same(to_mesh(volume, 1e-7), full)) << "float32 has steps of 1.9e-6 mm at 24 mm";
  for (const double bad :
       {-1e-9, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    EXPECT_THROW(to_mesh(volume, bad), std::invalid_argument) << bad;
  Volume empty = volume;
  for (dexel::Grid& grid : empty.grids())
    for (std::size_t t = 0; t < grid.tile_count(); ++t) grid.fill_tile(t, [](int, int, dexel::TileBuilder&) {});
  empty.touch();
  EXPECT_TRUE(to_mesh(empty, 0.1).empty());
}

TEST(AdaptiveMesh, CanBeCancelled) {
  const Volume volume = grooved(0.1, "xyz");
  double last = 0;
  const Mesh mesh = to_mesh(volume, 0.01, [&](double share) {
    EXPECT_GE(share, last);
    last = share;
    return true;
  });
  EXPECT_EQ(last, 1);
  for (const double stop : {0.1, 0.65, 0.8})
    EXPECT_THROW(to_mesh(volume, 0.01, [&](double share) { return share < stop; }), Cancelled) << stop;
}

}  // namespace
}  // namespace riffler::marching::adaptive_test
