#include "reference/swept_path.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "bench/scenes.hpp"

namespace riffler::reference::swept_path_test {
namespace {

const std::vector<Pose> kTurning{{{8, 10, 6}, glm::normalize(Vec3(-0.3, 0.1, 1))},
                                 {{14, 12, 5}, glm::normalize(Vec3(0.4, 0.2, 1))},
                                 {{20, 9, 7}, glm::normalize(Vec3(0.1, -0.4, 1))}};

Vec3 point(std::mt19937_64& random) {
  std::uniform_real_distribution<double> x(2, 26), y(2, 18), z(0, 14);
  const double px = x(random), py = y(random), pz = z(random);
  return {px, py, pz};
}

/// Smallest distance over `samples` + 1 poses of every move: never less than the true distance.
double sampled(const CutterDistance& cutter, std::span<const Pose> poses, const Vec3& p, int samples) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k + 1 < poses.size(); ++k) {
    const Motion motion(poses[k], poses[k + 1]);
    for (int i = 0; i <= samples; ++i) {
      const double t = static_cast<double>(i) / samples;
      const Vec3 w = p - motion.tip(t), o = motion.axis(t);
      const double z = glm::dot(w, o);
      least = std::min(least, cutter.distance(glm::length(w - z * o), z));
    }
  }
  return least;
}

TEST(SweptPath, FindsTheMinimumThatSamplingFinds) {
  std::mt19937_64 random(3);
  constexpr int kSamples = 4096;
  for (const bench::NamedCutter& tool : bench::named_cutters()) {
    const CutterDistance cutter(tool.tool.profile());
    const SweptPath path(tool.tool.profile(), kTurning);
    for (int k = 0; k < 40; ++k) {
      const Vec3 p = point(random);
      const double found = path.near(p, 30).distance(p), near_by = sampled(cutter, kTurning, p, kSamples);
      EXPECT_LE(found, near_by + 1e-9) << tool.name;
      EXPECT_GE(found, near_by - 30.0 / kSamples) << tool.name;  // no point of space moves 60 mm in the tool's frame
    }
  }
}

TEST(SweptPath, AnswersAllQueriesAlike) {
  std::mt19937_64 random(4);
  for (const bench::NamedCutter& tool : bench::named_cutters()) {
    const SweptPath path(tool.tool.profile(), kTurning);
    const SweptDistance first(tool.tool.profile(), Motion(kTurning[0], kTurning[1])),
        second(tool.tool.profile(), Motion(kTurning[1], kTurning[2]));
    for (int k = 0; k < 100; ++k) {
      const Vec3 p = point(random);
      const double expected = std::min(first(p), second(p));
      for (const double reach : {1.0, 30.0}) {
        const SweptPath::Near near = path.near(p, reach);
        EXPECT_NEAR(near.distance(p), std::min(expected, reach), 2e-9) << tool.name;
        EXPECT_EQ(near.inside(p), expected < 0) << tool.name;
        EXPECT_EQ(near.deeper(p, 0.5), expected < -0.5) << tool.name;
        EXPECT_EQ(near.farther(p, 0.5), expected > 0.5) << tool.name;
      }
    }
  }
}

/// Moves that Near leaves out are far from every point within its reach too.
TEST(SweptPath, ServesThePointsWithinReach) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> side(-1, 1);
  for (const bench::NamedCutter& tool : bench::named_cutters()) {
    const SweptPath path(tool.tool.profile(), kTurning);
    for (int k = 0; k < 100; ++k) {
      const Vec3 p = point(random);
      const double a = side(random), b = side(random), c = side(random);
      const Vec3 q = p + 0.8 * glm::normalize(Vec3(a, b, c));
      EXPECT_NEAR(path.near(p, 0.8).distance(q), std::min(0.8, path.near(q, 30).distance(q)), 2e-9) << tool.name;
    }
  }
}

TEST(SweptPath, SkipsOnlyFarPoints) {
  std::mt19937_64 random(6);
  for (const bench::NamedCutter& tool : bench::named_cutters()) {
    const SweptDistance swept(tool.tool.profile(), Motion(kTurning[0], kTurning[2]));
    for (int k = 0; k < 100; ++k) {
      const Vec3 p = point(random);
      EXPECT_LE(swept.lower_bound(p), swept.bracket(p, 1e-9).lower + 1e-9) << tool.name;
    }
  }
}

}  // namespace
}  // namespace riffler::reference::swept_path_test
