// Carving with hand tools, compared with the dense reference and closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "geom/math.hpp"
#include "reference/hull_path.hpp"
#include "riffler/base/parallel.hpp"
#include "riffler/sweep/carve.hpp"
#include "riffler/tool/cutters.hpp"
#include "riffler/tool/hand_tools.hpp"

namespace riffler::sweep {
namespace {

using Random = std::mt19937_64;

double between(Random& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
}
Vec3 direction(Random& random) {
  for (;;) {
    const Vec3 v{between(random, -1, 1), between(random, -1, 1), between(random, -1, 1)};
    if (const double n = glm::length(v); n > 0.1 && n < 1) return v / n;
  }
}
CarveOptions within(double tolerance, CarveMode mode = CarveMode::Remove) {
  CarveOptions options;
  options.tolerance = tolerance, options.mode = mode;
  return options;
}
RolledPose pose(const Vec3& tip, const Vec3& axis, const Vec3& towards) {
  return {tip, axis, glm::normalize(towards - glm::dot(towards, axis) * axis)};
}
RolledPose turned(const RolledPose& p, const Vec3& turn, const Vec3& way) {
  return {p.tip + way, geom::rotate_by(p.axis, turn), geom::rotate_by(p.forward, turn)};
}
Tool random_body(Random& random, double flat) {
  std::vector<Vec3> points;
  for (int k = 0; k < 5 + static_cast<int>(random() % 5); ++k)
    points.push_back(Vec3(between(random, -2, 2), between(random, -2, 2) * flat, between(random, 0, 5)));
  return hand_tools::convex({points});
}
std::vector<std::vector<Vec3>> corners(const Tool& tool) {
  std::vector<std::vector<Vec3>> out;
  for (const tool::Hull& hull : tool.hulls()) out.push_back(hull.vertices);
  return out;
}
Tool box(const Vec3& lower, const Vec3& upper) {
  std::vector<Vec3> points;
  for (int k = 0; k < 8; ++k)
    points.push_back({k & 1 ? upper.x : lower.x, k & 2 ? upper.y : lower.y, k & 4 ? upper.z : lower.z});
  return hand_tools::convex({points});
}

/// Points of the rays that are solid but deeper than `tolerance` in what is swept, or the reverse.
int wrong_points(const Volume& volume, const reference::HullPath& path, double tolerance, Random& random, int rays) {
  int wrong = 0;
  for (const dexel::Grid& grid : volume.grids())
    for (int k = 0; k < rays; ++k) {
      const int i = static_cast<int>(random() % grid.nu()), j = static_cast<int>(random() % grid.nv());
      const auto spans = grid.ray(i, j);
      std::vector<double> heights;
      for (const dexel::Span& s : spans)
        for (const double e : {s.near, s.far})
          for (const double d : {-2.5 * tolerance, 2.5 * tolerance}) heights.push_back(e + d);
      for (int m = 0; m < 4; ++m) heights.push_back(between(random, grid.box().lower.z, grid.box().upper.z));
      for (const double s : heights) {
        if (s < grid.box().lower.z || s > grid.box().upper.z) continue;
        const bool solid = std::any_of(spans.begin(), spans.end(), [&](auto& p) { return s >= p.near && s <= p.far; });
        const double d = path(to_world(grid.axis(), {grid.shifted_u(i), grid.shifted_v(j), s}), 2 * tolerance);
        wrong += solid ? d < -tolerance : d > tolerance;
      }
    }
  return wrong;
}

TEST(Hull, AgreesWithTheDenseReference) {
  Random random(135);
  constexpr double kTolerance = 0.02;
  for (int k = 0; k < 48; ++k) {
    const Tool tool = random_body(random, k % 3 == 0 ? 0.02 : 1);
    RolledPose at = pose({between(random, 4, 8), between(random, 4, 8), between(random, 3, 7)}, direction(random),
                         direction(random));
    std::vector<RolledPose> poses{at};
    for (int m = 0; m < 2; ++m) {
      const double angle = k % 4 == 0 ? 0 : k % 4 == 1 ? 1e-12 : between(random, 0, 0.9);
      const double way = k % 5 == 0 ? 0 : between(random, 0, 3);
      poses.push_back(at = turned(at, angle * direction(random), way * direction(random)));
    }
    Volume volume = Volume::block({{{0, 0, 0}, {12, 12, 10}}, 0.5, "xyz"});
    carve(volume, tool, poses, within(kTolerance));
    const reference::HullPath path(corners(tool), poses, 0.1 * kTolerance);
    EXPECT_EQ(wrong_points(volume, path, 1.1 * kTolerance, random, 12), 0) << "case " << k;
  }
}

TEST(Hull, NormalsFaceTheBody) {
  // A point in the material at a small distance from an end, along its normal, is that far from what was swept.
  Random random(136);
  constexpr double kOff = 0.02;
  int ends = 0, wrong = 0;
  for (const double angle : {0.0, 0.6}) {
    const Tool tool = hand_tools::chisel(6, 3, 0.7, 12, 0.3);
    const RolledPose from = pose({4, 6, 4}, glm::normalize(Vec3(-0.5, 0.2, 0.8)), {1, 0.3, 0});
    const std::vector<RolledPose> poses{from, turned(from, angle * direction(random), {4, 1, 0.5})};
    Volume volume = Volume::block({{{-2, -2, -2}, {14, 14, 12}}, 0.5, "xyz"});
    carve(volume, tool, poses, within(0.001));
    const reference::HullPath path(corners(tool), poses, 0.002);
    for (const dexel::Grid& grid : volume.grids())
      for (int k = 0; k < 60; ++k) {
        const int i = static_cast<int>(random() % grid.nu()), j = static_cast<int>(random() % grid.nv());
        const auto spans = grid.ray(i, j);
        const auto normals = grid.ray_normals(i, j);
        for (std::size_t m = 0; m + 1 < spans.size(); ++m)
          for (const auto& [s, n] :
               {std::pair(spans[m].far, normals[m].far), {spans[m + 1].near, normals[m + 1].near}}) {
            const Vec3 p = to_world(grid.axis(), {grid.shifted_u(i), grid.shifted_v(j), s});
            ++ends, wrong += path(p - kOff * n.unpack(), 1) < 0.95 * kOff;
          }
      }
  }
  EXPECT_GT(ends, 60);
  EXPECT_LE(wrong, ends / 25);
}

TEST(Hull, StraightMovesAreExactForAnyTolerance) {
  // a box of 2 x 4 mm pushed 5 mm along x, rays on its faces and edges
  Volume volume = Volume::block({{{0, 0, 0}, {20, 20, 10}}, 0.5, "z"});
  const Tool tool = box({0, -2.25, 0}, {2, 2.25, 20});
  const std::vector<RolledPose> poses{{{5.25, 10, 6}}, {{10.25, 10, 6}}};
  const Cut cut = carve(volume, tool, poses, within(1));
  EXPECT_NEAR(cut.removed[0], 7 * 4.5 * 4, 1e-9);
  EXPECT_NEAR(volume.volume(), 4000 - 126, 1e-9);
}

TEST(Hull, ZeroMotionRemovesTheBody) {
  for (const char* directions : {"z", "xyz"}) {
    Volume volume = Volume::block({{{0, 0, 0}, {20, 20, 10}}, 0.5, directions});
    const std::vector<RolledPose> poses{{{10, 10, 5}}, {{10, 10, 5}}};
    carve(volume, box({-2, -2, 0}, {2, 2, 2}), poses);
    EXPECT_NEAR(volume.volume(), 4000 - 32, 1e-9);
    carve(volume, box({-2, -2, 0}, {2, 2, 2}), poses, within(0.01, CarveMode::Add));
    EXPECT_NEAR(volume.volume(), 4000, 1e-9);
  }
}

TEST(Hull, ARodThatTurnsLeavesWhatItPassesOnBothSides) {
  // Rays along x past the middle of a thin rod that turns about z: the rod takes two intervals of such a ray.
  Volume volume = Volume::block({{{-10, -10, 0}, {10, 10, 2}}, 0.1, "x"});
  const Tool rod = box({-8, -0.05, 0}, {8, 0.05, 2});
  RolledPose from{{0, 0, 0}};
  from.forward = {std::cos(0.1), -std::sin(0.1), 0};
  const RolledPose to = turned(from, {0, 0, 0.2}, Vec3(0));
  carve(volume, rod, std::vector{from, to}, within(0.001));
  const auto spans = volume.grids()[0].ray(103, 5);  // y = 0.35
  ASSERT_EQ(spans.size(), 3U);
  const double middle = (0.35 * std::cos(0.1) - 0.05) / std::sin(0.1);
  EXPECT_NEAR(spans[1].near, -middle, 0.005);
  EXPECT_NEAR(spans[1].far, middle, 0.005);
}

TEST(Hull, FarFromTheOriginNothingIsLost) {
  const Vec3 far{1e5, -1e5, 1e5};
  const Tool tool = hand_tools::chisel(6, 3, 0.5, 20, 0.2);
  const RolledPose from = pose({4, 10, 6}, glm::normalize(Vec3(-0.6, 0.1, 0.8)), {1, 0, 0});
  const RolledPose to = turned(from, {0.02, 0.1, 0.15}, {6, 0.5, -0.5});
  Volume near = Volume::block({{{0, 0, 0}, {20, 20, 10}}, 0.25, "xyz"});
  Volume away = Volume::block({{far, far + Vec3(20, 20, 10)}, 0.25, "xyz"});
  const Cut a = carve(near, tool, std::vector{from, to}),
            b = carve(away, tool, std::vector{turned(from, Vec3(0), far), turned(to, Vec3(0), far)});
  EXPECT_GT(a.removed[0], 10);
  EXPECT_NEAR(a.removed[0], b.removed[0], 1e-3);
}

TEST(Hull, ThreadsAndDividedMovesAgree) {
  const Tool tool = hand_tools::gouge(8, 5, 0.6, 25);
  std::vector<RolledPose> poses{pose({3, 10, 7}, glm::normalize(Vec3(-0.7, 0, 0.7)), {1, 0, 0})};
  for (int k = 0; k < 20; ++k) poses.push_back(turned(poses.back(), {0, 0.01, 0.03 * std::cos(k)}, {0.7, 0, -0.05}));
  std::vector<Volume> volumes;
  std::vector<double> removed;
  for (const int threads : {1, 3}) {
    base::set_thread_count(threads);
    volumes.push_back(Volume::block({{{0, 0, 0}, {20, 20, 10}}, 0.2, "xyz"}));
    const Cut cut = carve(volumes.back(), tool, poses);
    for (const double r : cut.removed) removed.push_back(r);
  }
  base::set_thread_count(std::nullopt);
  for (std::size_t k = 0; k < 20; ++k) EXPECT_EQ(removed[k], removed[20 + k]);
  for (std::size_t g = 0; g < 3; ++g)
    for (std::size_t t = 0; t < volumes[0].grids()[g].tile_count(); ++t) {
      const auto &a = volumes[0].grids()[g].tile(t), &b = volumes[1].grids()[g].tile(t);
      ASSERT_EQ(a.spans.size(), b.spans.size());
      for (std::size_t k = 0; k < a.spans.size(); ++k) {
        EXPECT_EQ(a.spans[k].near, b.spans[k].near);
        EXPECT_EQ(a.spans[k].far, b.spans[k].far);
      }
    }
}

std::string error_of(const Tool& tool, const std::vector<RolledPose>& poses) {
  Volume volume = Volume::block({{{0, 0, 0}, {4, 4, 4}}, 0.5, "z"});
  try {
    carve(volume, tool, poses);
  } catch (const std::invalid_argument& e) {
    EXPECT_EQ(volume.volume(), 64);
    return e.what();
  }
  return "";
}

TEST(Hull, BadPosesAreNamed) {
  const Tool tool = hand_tools::knife(10, 2, 0.5, 40);
  const RolledPose p;
  EXPECT_NE(error_of(tool, {p, {{0, 0, 0}, {0, 0, 1}, {-1, 0, 0}}}).find("row 1: the tool is a half turn"),
            std::string::npos);
  EXPECT_NE(
      error_of(tool, {p, {{0, 0, 0}, {0, 0, 1}, {0.8, 0, 0.6}}}).find("row 1: the forward direction must be square"),
      std::string::npos);
  EXPECT_NE(error_of(tool, {p, {{0, 0, 0}, {0, 0, 2}, {1, 0, 0}}}).find("row 1: the axis must be a unit vector"),
            std::string::npos);
  EXPECT_NE(error_of(tool, {{{std::nan(""), 0, 0}}}).find("row 0: not finite"), std::string::npos);
  EXPECT_NE(error_of(cutters::ball(6, 30), {p, p}).find("six numbers"), std::string::npos);
  Volume volume = Volume::block({{{0, 0, 0}, {4, 4, 4}}, 0.5, "z"});
  EXPECT_THROW(carve(volume, tool, std::vector<Pose>{{}, {}}), std::invalid_argument);
}

}  // namespace
}  // namespace riffler::sweep
