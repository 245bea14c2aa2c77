// Normals at the corners of patches: the triangles they are computed from, and which patches need new ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include "marching/mesh_state.hpp"
#include "marching/vertex_star.hpp"
#include "riffler/marching/mesher.hpp"
#include "stress/mesh_scenes.hpp"
#include "support/effort.hpp"
#include "tests/marching/followed.hpp"

namespace riffler::marching::corner_normals_test {
namespace {

using namespace stress;
using namespace mesher_test;

/// Rays that contradict each other: cells with several sheets of surface, so with several vertices.
Volume contradictory(unsigned seed, const std::string& directions) {
  Random random(seed);
  Volume volume({{{0, 0, 0}, {11, 9, 10}}, 0.25, directions});
  fill(volume, [&](const dexel::Grid& grid, int, int) { return spans_at_random(random, grid, 0.8, true); });
  return volume;
}

TEST(VertexStar, HasTheTrianglesThatASearchThroughAllFinds) {
  std::size_t shared = 0;  // vertices of cells with several
  for (const char* directions : {"z", "xyz"}) {
    const Volume volume = contradictory(5, directions);
    const MeshState state(volume, true, {});
    const Mesh& mesh = state.surface.mesh;
    std::map<std::int32_t, std::vector<std::size_t>> expected;
    for (const std::size_t n : state.active_bricks()) {
      const ActiveBrick& brick = *state.bricks.active(n);
      for (std::size_t t = 2 * brick.first_edge; t < 2 * (brick.first_edge + brick.edges()); ++t)
        for (int c = 0; c < 3; ++c) expected[mesh.triangles[t][c]].push_back(t);
    }
    VertexStar star(state.surface);
    for (const std::size_t n : state.active_bricks()) {
      const ActiveBrick& brick = *state.bricks.active(n);
      for (int i = 0; i < kBrickSide; ++i)
        for (int j = 0; j < kBrickSide; ++j) shared += brick.vertex_after(i, j) - brick.vertex(i, j) > kBrickSide;
      for (std::size_t v = brick.first_vertex; v < brick.first_vertex + brick.vertices(); ++v) {
        std::vector<std::size_t>& all = expected[static_cast<std::int32_t>(v)];
        std::sort(all.begin(), all.end());
        ASSERT_EQ(star.of(brick, static_cast<std::int32_t>(v)), all) << directions << ", vertex " << v;
      }
    }
  }
  EXPECT_GT(shared, 0U);
}

constexpr double kSharp = 0.35;

std::map<std::size_t, base::BulkVector<Vec3f>> normals_of(const Mesher& mesher) {
  std::map<std::size_t, base::BulkVector<Vec3f>> out;
  for (const std::size_t n : mesher.patches()) out[n] = mesher.corner_normals(mesher.patch(n), kSharp);
  return out;
}

double farthest(const base::BulkVector<Vec3f>& a, const base::BulkVector<Vec3f>& b) {
  if (a.size() != b.size()) return 2;
  double out = 0;
  for (std::size_t n = 0; n < a.size(); ++n) out = std::max<double>(out, glm::length(a[n] - b[n]));
  return out;
}

/// Follows a volume with two meshers, one of which also names the patches with other normals.
class Followed {
 public:
  Followed(const Volume& volume, double tolerance)
      : tolerance_(tolerance), with_(made(volume)), without_(made(volume)) {
    shown_ = normals_of(with_);
  }
  /// Patches that the update does not name keep their normals.
  void expect_right_after(Volume& volume, const std::string& what) {
    const std::vector<std::size_t> meshed = without_.update(volume), shaded = with_.update(volume, true);
    ASSERT_TRUE(std::includes(shaded.begin(), shaded.end(), meshed.begin(), meshed.end())) << what;
    ++updates, named += shaded.size();
    for (const std::size_t n : shaded) {
      base::BulkVector<Vec3f> normals = with_.corner_normals(with_.patch(n), kSharp);
      if (!std::binary_search(meshed.begin(), meshed.end(), n)) beside += farthest(normals, shown_[n]) > 1e-3;
      if (normals.empty())
        shown_.erase(n);
      else
        shown_[n] = std::move(normals);
    }
    const std::map<std::size_t, base::BulkVector<Vec3f>> expected = normals_of(made(volume));
    ASSERT_EQ(shown_.size(), expected.size()) << what;
    for (const auto& [n, normals] : expected) ASSERT_LT(farthest(shown_[n], normals), 1e-5) << what << ", brick " << n;
  }
  std::size_t updates = 0, named = 0;
  std::size_t beside = 0;  // patches with the same triangles and other normals

 private:
  Mesher made(const Volume& volume) const { return tolerance_ > 0 ? Mesher(volume, tolerance_) : Mesher(volume); }
  double tolerance_;
  Mesher with_, without_;
  std::map<std::size_t, base::BulkVector<Vec3f>> shown_;
};

TEST(CornerNormals, OfPatchesThatAnUpdateDoesNotNameStay) {
  for (const double tolerance : {0.0, 0.02})
    for (const char* directions : {"z", "xyz"}) {
      if (test::kSanitized && *directions == 'z') continue;
      Volume volume = Volume::block({{{0, 0, 0}, {30, 24, 21}}, 0.25, directions});
      Followed followed(volume, tolerance);
      Random random(17);
      for (int stroke = 0; stroke < test::cases(8); ++stroke) {
        carve_at_random(volume, stroke, random);
        followed.expect_right_after(volume, std::string(directions) + ", stroke " + std::to_string(stroke));
        if (HasFatalFailure()) return;
      }
      EXPECT_LT(followed.named, 32 * followed.updates);  // of 64 with triangles
    }
}

/// Dishes with slopes of 15° and 2° at their rims, which end at all distances from a border of bricks. The second is
/// within the tolerance, so triangles stay where normals change.
TEST(CornerNormals, ChangeInPatchesNextToAChange) {
  std::size_t beside = 0;
  for (const double depth : {0.2, 0.005})
    for (const double tolerance : {0.0, 0.1})
      for (int n = 0; n < 12; n += test::kSanitized ? 3 : 1) {
        Volume volume = Volume::block({{{0, 0, 0}, {11, 4, 5}}, 0.25, n % 2 ? "xyz" : "z"});
        Followed followed(volume, tolerance);
        const double radius = 6, reach = std::sqrt(radius * radius - (radius - depth) * (radius - depth));
        const Pose at{{8.6 - reach - 0.2 * n, 0.5, 5 - depth}, {0, 0, 1}};
        sweep::carve(volume, cutters::ball(2 * radius, 30), std::array{at, at});
        followed.expect_right_after(volume, "depth " + std::to_string(depth) + ", dish " + std::to_string(n));
        if (HasFatalFailure()) return;
        beside += followed.beside;
      }
  EXPECT_GT(beside, 0U);
}

/// A box whose corner moves through the corner of eight bricks: at one place a brick has a vertex and no triangles.
TEST(CornerNormals, NextToABrickWithAVertexAndNoTriangles) {
  std::size_t without = 0;
  for (const double tolerance : {0.0, 0.01})
    for (int n = 27; n < 36; n += test::kSanitized ? 4 : 1) {
      const double h = 0.25, from = n * h + 0.1;
      Volume volume({{{0, 0, 0}, {11, 11, 11}}, h, "xyz"});
      fill(volume, [&](const dexel::Grid& grid, int i, int j) {
        const Vec3 p = to_world(grid.axis(), Vec3(grid.u(i), grid.v(j), 0));
        return box(Vec3(from), Vec3(10.1))(p, to_world(grid.axis(), Vec3(0, 0, 1)));
      });
      const MeshState state(volume, true, {});
      for (const std::size_t k : state.active_bricks())
        without += state.bricks.active(k)->vertices() > 0 && state.bricks.active(k)->edges() == 0;
      const Mesher mesher = tolerance > 0 ? Mesher(volume, tolerance) : Mesher(volume);
      const std::vector<std::size_t> all = mesher.patches();
      const base::BulkVector<Vec3f> whole = mesher.corner_normals(mesher.patch(all), kSharp);
      base::BulkVector<Vec3f> parts;
      for (const std::size_t k : all)
        for (const Vec3f& normal : mesher.corner_normals(mesher.patch(k), kSharp)) parts.push_back(normal);
      ASSERT_LT(farthest(parts, whole), 1e-6) << tolerance << ", " << n;
    }
  EXPECT_GT(without, 0U);
}

}  // namespace
}  // namespace riffler::marching::corner_normals_test
