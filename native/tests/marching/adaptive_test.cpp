// to_mesh with a tolerance: judged by an audit and a distance of their own, which share no code with the mesher.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "riffler/base/parallel.hpp"
#include "riffler/marching/to_mesh.hpp"
#include "riffler/sweep/carve.hpp"
#include "riffler/tool/cutters.hpp"
#include "stress/float_audit.hpp"
#include "stress/mesh_checks.hpp"

namespace riffler::marching::adaptive_test {
namespace {

bool same(const Mesh& a, const Mesh& b) {
  return a.vertices == b.vertices && a.triangles == b.triangles;
}

/// Everything that a tolerance promises.
void expect_kept(const Volume& volume, double tolerance, const std::string& what) {
  EXPECT_EQ(stress::check_within(to_mesh(volume, tolerance), to_mesh(volume), tolerance), "") << what;
}

Volume grooved(double pitch, const char* directions) {
  Volume volume = Volume::block({{{0, 0, 0}, {24, 18, 9}}, pitch, directions});
  const std::array moves{Pose{{3, 4, 7.5}, {0, 0, 1}}, Pose{{20, 11, 7}, {0, 0, 1}},
                         Pose{{8, 15, 6.5}, glm::normalize(Vec3(0.3, 0, 1))}};
  sweep::carve(volume, cutters::ball(5, 40), moves);
  return volume;
}

TEST(AdaptiveMesh, OfACarvedBlockNeedsFewTriangles) {
  for (const char* directions : {"xyz", "z", "y"})
    for (const double tolerance : {0.0005, 0.01, 0.1}) {
      if (test::kSanitized && tolerance != 0.01) continue;
      const Volume volume = grooved(0.25, directions);
      expect_kept(volume, tolerance, directions + std::to_string(tolerance));
    }
  if (test::kSanitized) return;  // a finer one
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
