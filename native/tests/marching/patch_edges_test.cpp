#include "marching/patch_edges.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "marching/pick_scenes.hpp"
#include "support/error_of.hpp"

namespace riffler::marching::patch_edges_test {
namespace {

using namespace stress;
using test::Scene;

/// Corners of a triangle by their places, the least first, in their order.
using Corners = std::array<std::array<float, 3>, 3>;

Corners corners_of(const MeshPatch& patch, const Vec3i& t) {
  Corners out;
  for (int c = 0; c < 3; ++c) {
    const Vec3f& v = patch.vertices[t[c]];
    out[c] = {v.x, v.y, v.z};
  }
  std::rotate(out.begin(), std::min_element(out.begin(), out.end()), out.end());
  return out;
}

std::vector<Corners> sorted_triangles(const std::vector<MeshPatch>& patches) {
  std::vector<Corners> out;
  for (const MeshPatch& patch : patches)
    for (const Vec3i& t : patch.triangles) out.push_back(corners_of(patch, t));
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<MeshPatch> singly(const Mesher& mesher, const std::vector<std::size_t>& bricks) {
  std::vector<MeshPatch> out;
  for (const std::size_t n : bricks) out.push_back(mesher.patch(n));
  return out;
}

/// No vertex twice, none unused.
void expect_welded(const MeshPatch& patch, const std::string& what) {
  std::set<std::array<float, 3>> places;
  for (const Vec3f& v : patch.vertices) places.insert({v.x, v.y, v.z});
  EXPECT_EQ(places.size(), patch.vertices.size()) << what;
}

TEST(Patch, OfSeveralBricksJoinsTheirPatchesWithoutSeams) {
  for (const Scene& scene : test::scenes()) {
    const Mesher mesher(scene.volume);
    const std::vector<std::size_t> all = mesher.patches();
    ASSERT_GT(all.size(), 2U) << scene.name;
    Random random(2);
    for (int round = 0; round < 8; ++round) {
      std::vector<std::size_t> some;
      for (const std::size_t n : all)
        if (random.one_in(2)) some.insert(some.begin() + random.below(static_cast<int>(some.size()) + 1), n);
      const MeshPatch merged = mesher.patch(some);
      EXPECT_EQ(sorted_triangles({merged}), sorted_triangles(singly(mesher, some))) << scene.name;
      expect_welded(merged, scene.name);
    }
  }
}

TEST(Patch, OfAllBricksIsTheMesh) {
  for (const Scene& scene : test::scenes()) {
    const Mesher mesher(scene.volume);
    const Mesh mesh = mesher.mesh();
    MeshPatch whole;
    for (const Vec3& v : mesh.vertices) whole.vertices.emplace_back(v);
    whole.triangles = mesh.triangles;
    const MeshPatch patch = mesher.patch(mesher.patches());
    EXPECT_EQ(patch.own, mesh.vertices.size()) << scene.name;
    EXPECT_EQ(patch.vertices.size(), mesh.vertices.size()) << scene.name;
    EXPECT_EQ(sorted_triangles({patch}), sorted_triangles({whole})) << scene.name;
  }
}

TEST(Patch, OfOneBrickIsThePatchOfThatBrick) {
  const Mesher mesher(test::scenes()[0].volume);
  for (const std::size_t n : mesher.patches()) {
    const MeshPatch one = mesher.patch(n), list = mesher.patch(std::vector{n});
    EXPECT_EQ(one.own, list.own);
    EXPECT_TRUE(std::equal(one.vertices.begin(), one.vertices.end(), list.vertices.begin(), list.vertices.end()));
    EXPECT_TRUE(std::equal(one.triangles.begin(), one.triangles.end(), list.triangles.begin(), list.triangles.end()));
  }
  EXPECT_TRUE(mesher.patch(std::vector<std::size_t>{}).vertices.empty());
}

TEST(Patch, RefusesRepeatedAndMissingBricks) {
  const Mesher mesher(test::scenes()[0].volume);
  EXPECT_EQ(test::error_of([&] { mesher.patch(std::vector<std::size_t>{2, 1, 2}); }), "bricks: 2 is listed twice");
  EXPECT_THROW(mesher.patch(std::vector<std::size_t>{1, 100000}), std::out_of_range);
}

TEST(Mesher, ReportsThePlacesOfItsBricks) {
  const Mesher mesher(Volume::block({{{0, 0, 0}, {20, 10, 30}}, 0.25, "xyz"}));
  EXPECT_EQ(mesher.shape(), Vec3i(3, 2, 4));  // 82, 42 and 122 points
  for (const std::size_t n : mesher.patches()) {
    const int place = static_cast<int>(n);
    const Vec3i at(place / 8, place / 4 % 2, place % 4);
    for (const Vec3f& v : mesher.patch(n).vertices)
      for (int a = 0; a < 3; ++a) {
        EXPECT_GE(v[a], 8.0 * at[a] - 0.125 - 0.25 - 0.25);
        EXPECT_LE(v[a], 8.0 * (at[a] + 1) - 0.125 + 0.25);
      }
  }
}

TEST(PatchEdges, AreUniqueAndAgreeWithTheCorners) {
  for (const Scene& scene : test::scenes()) {
    const Mesher mesher(scene.volume);
    std::vector<MeshPatch> patches = singly(mesher, mesher.patches());
    patches.push_back(mesher.patch(mesher.patches()));
    const std::size_t closed = patches.size() - 1;
    for (std::size_t p = 0; p < patches.size(); ++p) {
      const MeshPatch& patch = patches[p];
      const PatchEdges edges = edges_of(patch);
      std::map<std::pair<int, int>, int> uses;
      std::size_t wrong = 0;
      ASSERT_EQ(edges.of_corner.size(), patch.triangles.size());
      for (std::size_t t = 0; t < patch.triangles.size(); ++t)
        for (int c = 0; c < 3; ++c) {
          const int from = patch.triangles[t][c], to = patch.triangles[t][(c + 1) % 3];
          const Vec2i& edge = edges.vertices.at(edges.of_corner[t][c]);
          wrong += std::minmax(edge.x, edge.y) != std::minmax(from, to);
          ++uses[std::minmax(from, to)];
        }
      EXPECT_EQ(wrong, 0U) << scene.name;
      EXPECT_EQ(edges.vertices.size(), uses.size()) << scene.name;
      if (p == closed) {
        EXPECT_EQ(2 * edges.vertices.size(), 3 * patch.triangles.size()) << scene.name;
      }
    }
  }
}

TEST(PatchEdges, OfNoTrianglesAreNone) {
  EXPECT_TRUE(edges_of({}).vertices.empty());
  EXPECT_TRUE(edges_of({}).of_corner.empty());
}

}  // namespace
}  // namespace riffler::marching::patch_edges_test
