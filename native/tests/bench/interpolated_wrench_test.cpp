#include "bench/interpolated_wrench.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace riffler::bench::interpolated_wrench_test {
namespace {

TEST(InterpolatedWrench, IsAPeriodLate) {
  InterpolatedWrench scheme(0.01);
  double worst = 0;
  for (int k = 0; k < 1000; ++k) {
    if (k % 10 == 0) scheme.computed({{1e-3 * k, 0, 0}, {}});
    const double now = scheme.tick(1e-3).force.x;
    if (k > 20) worst = std::max(worst, std::abs(now - 1e-3 * (k + 1 - 10)));
  }
  EXPECT_LT(worst, 1e-12);
}

}  // namespace
}  // namespace riffler::bench::interpolated_wrench_test
