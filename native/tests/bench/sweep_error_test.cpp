// The measure itself: that the reference is as good as plain dense sampling, and that wrong cuts are seen.
#include "bench/sweep_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "bench/capsule_loop.hpp"
#include "bench/dense_path.hpp"
#include "bench/dense_sweep.hpp"
#include "bench/scenes.hpp"
#include "sweep/carve.hpp"
#include "tool/cutters.hpp"

namespace riffler {
namespace {

const std::vector<Pose> kTurning{{{8, 10, 6}, glm::normalize(Vec3(-0.3, 0.1, 1))},
                                 {{14, 12, 5}, glm::normalize(Vec3(0.4, 0.2, 1))},
                                 {{20, 9, 7}, glm::normalize(Vec3(0.1, -0.4, 1))}};

Volume carved(const Tool& tool, double tolerance) {
  Volume volume = Volume::block({{{0, 0, 0}, {28, 20, 14}}, 0.5, "z"});
  CarveOptions options;
  options.tolerance = tolerance;
  carve(volume, tool, kTurning, options);
  return volume;
}

double largest(const bench::SweepErrors& errors) {
  double out = 0;
  for (const bench::EndError& e : errors.ends) out = std::max(out, e.error());
  return out;
}

TEST(DensePath, FindsTheLeastThatPlainSamplingFinds) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> x(2, 26), y(2, 18), z(0, 14);
  for (const bench::NamedCutter& cutter : bench::named_cutters()) {
    const reference::DensePath path(cutter.tool.profile(), kTurning);
    const Motion first(kTurning[0], kTurning[1]), second(kTurning[1], kTurning[2]);
    for (int k = 0; k < 100; ++k) {
      const Vec3 p{x(random), y(random), z(random)};
      const auto plain = [&](const Motion& m) { return reference::swept_distance(cutter.tool.profile(), m, p, 4096); };
      const double expected = std::min(plain(first), plain(second));
      const reference::DensePath::Near near = path.near(p, 30);
      EXPECT_NEAR(near.distance(p), expected, 1e-9) << cutter.name;
      EXPECT_EQ(near.inside(p), expected < 0) << cutter.name;
      EXPECT_EQ(near.deeper(p, 0.5), expected < -0.5) << cutter.name;
      EXPECT_EQ(near.farther(p, 0.5), expected > 0.5) << cutter.name;
    }
  }
}

TEST(SweepErrors, AreWithinTheToleranceOfACarveAndNotZero) {
  const Tool ball = cutters::ball(6, 30);
  const bench::SweepErrors errors = bench::sweep_errors(carved(ball, 0.01), ball, kTurning, 0.01, 200, 1);
  EXPECT_GT(errors.ends.size(), 100u);
  EXPECT_EQ(errors.wrong, 0u);
  EXPECT_LE(largest(errors), 0.01);
  EXPECT_GT(largest(errors), 0.0);
}

TEST(SweepErrors, SeeACutterThatIsTooSmall) {
  const Tool ball = cutters::ball(6, 30), small = cutters::ball(5.98, 30);
  const bench::SweepErrors errors = bench::sweep_errors(carved(small, 0.001), ball, kTurning, 0.001, 200, 1);
  EXPECT_GT(largest(errors), 0.007);  // the search ends at 8 tolerances
  EXPECT_GT(errors.wrong, 0u);        // the middles of what was left standing, 0.01 mm thick
}

TEST(SweepErrors, SeeAMoveThatIsMissing) {
  const Tool flat = cutters::flat(6, 30);
  Volume volume = Volume::block({{{0, 0, 0}, {28, 20, 14}}, 0.5, "z"});
  carve(volume, flat, std::span(kTurning).first(2));
  EXPECT_GT(bench::sweep_errors(volume, flat, kTurning, 0.01, 200, 1).wrong, 10u);
}

TEST(CapsuleLoop, RemovesWhatABallEndMillDoes) {
  bench::CapsuleLoop loop(0.25);
  loop.run();
  EXPECT_NEAR(loop.removed(), 2944.75, 1.5);  // and the pitch's share of it
  loop.reset();
  EXPECT_EQ(loop.removed(), 0.0);
}

}  // namespace
}  // namespace riffler
