// The measure itself: that wrong cuts are seen.
#include "bench/sweep_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "bench/capsule_loop.hpp"
#include "riffler/sweep/carve.hpp"
#include "riffler/tool/cutters.hpp"

namespace riffler::bench::sweep_error_test {
namespace {

const std::vector<Pose> kTurning{{{8, 10, 6}, glm::normalize(Vec3(-0.3, 0.1, 1))},
                                 {{14, 12, 5}, glm::normalize(Vec3(0.4, 0.2, 1))},
                                 {{20, 9, 7}, glm::normalize(Vec3(0.1, -0.4, 1))}};

Volume carved(const Tool& tool, double tolerance) {
  Volume volume = Volume::block({{{0, 0, 0}, {28, 20, 14}}, 0.5, "z"});
  sweep::CarveOptions options;
  options.tolerance = tolerance;
  sweep::carve(volume, tool, kTurning, options);
  return volume;
}

double largest(const bench::SweepErrors& errors) {
  double out = 0;
  for (const bench::EndError& e : errors.ends) out = std::max(out, e.error());
  return out;
}

TEST(SweepErrors, AreWithinTheToleranceOfACarveAndNotZero) {
  const Tool ball = cutters::ball(6, 30);
  const bench::SweepErrors errors = bench::sweep_errors(carved(ball, 0.01), ball, kTurning, 0.01, 200, 1);
  EXPECT_GT(errors.ends.size(), 100u);
  EXPECT_EQ(errors.wrong, 0u);
  EXPECT_LE(largest(errors), 0.01);
  EXPECT_GT(largest(errors), 0.0);
}

TEST(SweepErrors, ShowACutterThatIsTooSmall) {
  const Tool ball = cutters::ball(6, 30), small = cutters::ball(5.98, 30);
  const bench::SweepErrors errors = bench::sweep_errors(carved(small, 0.001), ball, kTurning, 0.001, 200, 1);
  EXPECT_GT(largest(errors), 0.007);  // the search ends at 8 tolerances
  EXPECT_GT(errors.wrong, 0u);        // the middles of what was left standing, 0.01 mm thick
}

TEST(SweepErrors, ShowAMissingMove) {
  const Tool flat = cutters::flat(6, 30);
  Volume volume = Volume::block({{{0, 0, 0}, {28, 20, 14}}, 0.5, "z"});
  sweep::carve(volume, flat, std::span(kTurning).first(2));
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
}  // namespace riffler::bench::sweep_error_test
