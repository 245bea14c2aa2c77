// Compares a mesher that followed changes with a new mesh.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "riffler/marching/mesher.hpp"
#include "riffler/sweep/carve.hpp"
#include "riffler/tool/cutters.hpp"
#include "stress/random.hpp"

namespace riffler::marching::mesher_test {

/// Expects that a mesher has the bytes of a mesh.
inline void expect_mesh(const Mesher& mesher, const Mesh& whole, const std::string& what) {
  const Mesh followed = mesher.mesh();
  ASSERT_EQ(followed.vertices.size(), whole.vertices.size()) << what;
  ASSERT_EQ(followed.triangles.size(), whole.triangles.size()) << what;
  std::size_t vertices = 0, triangles = 0;
  for (std::size_t n = 0; n < whole.vertices.size(); ++n) vertices += followed.vertices[n] != whole.vertices[n];
  for (std::size_t n = 0; n < whole.triangles.size(); ++n) triangles += followed.triangles[n] != whole.triangles[n];
  EXPECT_EQ(vertices, 0U) << what << ", of " << whole.vertices.size();
  EXPECT_EQ(triangles, 0U) << what << ", of " << whole.triangles.size();
}

/// Copies of patches, updated where the mesher reports a change, and put together again by equal places.
class Patches {
 public:
  explicit Patches(const Mesher& mesher) {
    for (const std::size_t n : mesher.patches()) patches_[n] = mesher.patch(n);
  }
  void update(const Mesher& mesher, const std::vector<std::size_t>& changed) {
    for (const std::size_t n : changed) patches_[n] = mesher.patch(n);
  }
  void expect_same(const Mesh& whole, const std::string& what) const {
    std::unordered_map<std::array<float, 3>, int, PlaceHash> numbers(whole.vertices.size());
    for (const Vec3& v : whole.vertices) {
      const Vec3f f(v);
      numbers.emplace(std::array{f.x, f.y, f.z}, static_cast<int>(numbers.size()));
    }
    std::vector<std::array<int, 3>> triangles, expected;
    for (const auto& [brick, patch] : patches_)
      for (const Vec3i& t : patch.triangles) {
        std::array<int, 3> triangle;
        for (int c = 0; c < 3; ++c) {
          const Vec3f& v = patch.vertices[t[c]];
          const auto found = numbers.find({v.x, v.y, v.z});
          ASSERT_NE(found, numbers.end()) << what << ": brick " << brick << " has a vertex that the mesh has not";
          triangle[c] = found->second;
        }
        triangles.push_back(triangle);
      }
    for (const Vec3i& t : whole.triangles) expected.push_back({t.x, t.y, t.z});
    std::sort(triangles.begin(), triangles.end());
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(triangles.size(), expected.size()) << what;
    EXPECT_TRUE(triangles == expected) << what;
  }

 private:
  struct PlaceHash {
    std::size_t operator()(const std::array<float, 3>& place) const {
      std::uint64_t out = 0;
      for (const float x : place) out = (out ^ std::bit_cast<std::uint32_t>(x + 0.0F)) * 0x9E3779B97F4A7C15U;
      return static_cast<std::size_t>(out >> 16);
    }
  };
  std::map<std::size_t, MeshPatch> patches_;
};

/// A stroke of a cutter at a random place and angle in the upper half of a block 30 × 24 × 21 mm from the origin.
inline void carve_at_random(Volume& volume, int stroke, stress::Random& random) {
  const Tool tools[] = {cutters::ball(3, 40), cutters::flat(2.5, 40), cutters::taper(0.4, 0.3, 4, 40)};
  const auto pose = [&] {
    Vec3 axis = random.direction();
    axis.z = std::abs(axis.z) + 0.3;
    return Pose{{random.uniform(0, 30), random.uniform(0, 24), random.uniform(12, 22)}, glm::normalize(axis)};
  };
  Pose from = pose(), to = from;
  to.tip += 2.0 * random.direction();
  sweep::carve(volume, tools[stroke % 3], std::array{from, to});
}

}  // namespace riffler::marching::mesher_test
