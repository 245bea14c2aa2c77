// Surfaces of several bricks for tests of what is asked of a mesher.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "riffler/marching/mesher.hpp"
#include "riffler/sweep/carve.hpp"
#include "riffler/tool/cutters.hpp"
#include "stress/mesh_scenes.hpp"

namespace riffler::test {

struct Scene {
  std::string name;
  Volume volume;
};

/// A cut of a ball somewhere along a bar.
inline void nick(Volume& bar, stress::Random& random) {
  const Box3& box = bar.frame().box;
  const double x = random.uniform(box.lower.x, box.upper.x);
  const Vec3 tip(x, (box.lower.y + box.upper.y) / 2, box.upper.z - random.uniform(0.5, 1.5));
  const Vec3 axis = glm::normalize(Vec3(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), 1));
  sweep::carve(bar, cutters::ball(1.5, 20), std::array{Pose{tip, axis}, Pose{tip + 0.7 * random.direction(), axis}});
}

/// A bar through some bricks, nicked.
inline Volume nicked_bar(const Vec3& lower, const Vec3& size, const char* directions) {
  Volume bar = Volume::block({{lower, lower + size}, 0.25, directions});
  stress::Random random(5);
  for (int n = 0; n < 12; ++n) nick(bar, random);
  return bar;
}

/// Bars along each axis, one of them far out, one of rays in one direction, and rays that contradict each other.
inline std::vector<Scene> scenes() {
  std::vector<Scene> out{
      {"bar", nicked_bar({0, 0, 0}, {24, 4, 3}, "xyz")},
      {"upright bar far out", nicked_bar({1e5, -1e5, 3e4}, {4, 3, 20}, "xyz")},
      {"bar of z rays", nicked_bar({-3, -20, 1}, {4, 24, 3}, "z")},
      {"bar of x rays", nicked_bar({-3, -20, 1}, {4, 24, 3}, "x")},
  };
  const Vec3 lower(7, 0, -5), size(20, 2.5, 2.5);
  Volume wild({{lower, lower + size}, 0.25, "xyz"});
  stress::Random random(11);
  stress::fill(wild,
               [&](const dexel::Grid& grid, int, int) { return stress::spans_at_random(random, grid, 0.5, true); });
  out.push_back({"rays that contradict each other", std::move(wild)});
  return out;
}

}  // namespace riffler::test
