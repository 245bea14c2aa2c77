// A minute of planning by feel with the simulated pen, or ten where RIFFLER_LONG is set (`make soak`): energy is
// never given, memory stays what it is, and no step allocates.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "stress/orienting_run.hpp"
#include "support/allocations.hpp"
#include "support/effort.hpp"

namespace riffler::session::orienting_stress_test {
namespace {

void print(double seconds, stress::OrientingRun& run) {
  auto& s = run.step_seconds;
  std::ranges::sort(s);
  const auto at = [&](double q) { return 1e6 * s[static_cast<std::size_t>(q * static_cast<double>(s.size() - 1))]; };
  std::printf("%.0f s of planning by feel, %lu steps: median %.0f us, 99 %% %.0f us, 99.9 %% %.0f us\n", seconds,
              run.steps, at(0.5), at(0.99), at(0.999));
  std::printf("  energy: account at least %.3f N mm, taken from the hand %.0f, given at most %.3f; torque up to %.0f\n",
              run.account, run.taken, run.gained, run.greatest);
  std::printf(
      "  memory: %.1f MB after a tenth, %.1f at the end; in steps %ld allocations, %lu blocks from the system\n",
      run.resident[1], run.resident.back(), run.allocations, run.from_system);
  std::printf("  shank or holder touched in %lu steps, %.2f mm deep at most; %lu keys set, %lu deleted\n", run.touched,
              run.deepest, run.set, run.deleted);
}

TEST(Orienting, TheLastMinuteIsLikeTheFirst) {
  const double seconds = test::kSanitized ? 20 : std::getenv("RIFFLER_LONG") ? 600 : 60;
  stress::OrientingRun run = stress::orienting_run(
      {.seconds = seconds, .warm = std::min(30.0, seconds / 2), .allocations = &test::allocations});
  print(seconds, run);
  EXPECT_NEAR(static_cast<double>(run.steps), 1000 * seconds, 2 * seconds);
  // Ten seconds of warm-up do not meet every contact that the next ten have.
  EXPECT_LE(run.allocations, test::kSanitized ? 5 : 0);
  EXPECT_LE(run.from_system, test::kSanitized ? 5U : 0U);
  EXPECT_EQ(run.missed, 0U);
  EXPECT_EQ(run.dropped, 0U);
  EXPECT_EQ(run.understated, 0U);  // the reported depth is a bound
  EXPECT_GE(run.account, 0);
  EXPECT_LT(run.gained, 1.1);  // the reserve, and a frame's worth
  EXPECT_GT(run.greatest, 100);
  EXPECT_GT(run.touched, 40 * seconds);
  EXPECT_LT(run.deepest, 1.2);
  EXPECT_GT(run.set, seconds / 6);
  EXPECT_GT(run.deleted, seconds / 12);
  if (test::kSanitized) return;  // memory is the sanitizer's
  // The log of step times is part of it, 4 bytes each.
  EXPECT_LT(run.resident.back(), run.resident[1] + 1 + 4e-6 * static_cast<double>(run.steps));
}

}  // namespace
}  // namespace riffler::session::orienting_stress_test
