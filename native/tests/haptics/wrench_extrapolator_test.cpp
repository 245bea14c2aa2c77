#include "riffler/haptics/wrench_extrapolator.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "stress/random.hpp"
#include "support/error_of.hpp"

namespace riffler::haptics::wrench_extrapolator_test {
namespace {

TEST(WrenchExtrapolator, PassesOnWrenchesThatComeInTime) {
  WrenchExtrapolator held;
  for (int k = 0; k < 100; ++k) {
    const Wrench w{{std::sin(0.1 * k), 0, 1}, {0, 10, 0}};
    const Wrench out = held.stepped(w, 1e-3);
    if (k > 0) {
      EXPECT_EQ(out, w);
    }
  }
}

TEST(WrenchExtrapolator, NeverJumpsForAnyMissingSteps) {
  stress::Random random(3);
  const WrenchExtrapolatorSettings s;
  WrenchExtrapolator held;
  Wrench last, wanted;
  bool out_of_time = false;
  for (int k = 0; k < 100'000; ++k) {
    const double dt = random.one_in(20) ? random.uniform(1e-3, 40e-3) : 1e-3;
    if (random.one_in(30)) out_of_time = !out_of_time;
    if (random.one_in(10))
      wanted = {random.uniform(0, 8) * random.direction(), random.uniform(0, 400) * random.direction()};
    if (random.one_in(1000)) wanted.force.x = NAN;
    const Wrench now = out_of_time ? held.missed(dt) : held.stepped(wanted, dt);
    ASSERT_TRUE(finite(now));
    ASSERT_LE(glm::length(now.force - last.force), s.rate.linear * dt * (1 + 1e-12));
    ASSERT_LE(glm::length(now.torque - last.torque), s.rate.angular * dt * (1 + 1e-12));
    ASSERT_LE(glm::length(now.force), s.most.linear * (1 + 1e-12));
    last = now;
  }
}

TEST(WrenchExtrapolator, ContinuesForAWhileAndFadesInTime) {
  WrenchExtrapolator held;
  held.stepped({{0.99, 0, 0}, {}}, 1e-3);
  held.stepped({{1, 0, 0}, {}}, 1e-3);
  // 10 N/s continues: after 1 ms three quarters of 10 mN · 2 ms / 2, and 5 % of the fade.
  EXPECT_NEAR(held.missed(1e-3).force.x, 0.95 * 1.0075, 1e-12);
  for (int k = 0; k < 18; ++k) EXPECT_GT(held.missed(1e-3).force.x, 0);
  EXPECT_NEAR(held.age(), 19e-3, 1e-12);
  held.missed(1e-3);
  EXPECT_NEAR(held.missed(1e-3).force.x, 0, 1e-12);
  // A single late tick is nothing to be felt: of a ramp, what is missing of the ramp.
  WrenchExtrapolator ramp;
  for (int k = 0; k < 50; ++k) ramp.stepped({{0.01 * k, 0, 0}, {}}, 1e-3);
  EXPECT_NEAR(ramp.missed(1e-3).force.x, 0.5, 0.05 * 0.5 + 0.005);
}

TEST(WrenchExtrapolator, TicksOfNoTimeAndNanChangeNothing) {
  WrenchExtrapolator held;
  held.stepped({{1, 0, 0}, {}}, 1e-3);
  const Wrench before = held.missed(0);
  EXPECT_EQ(held.missed(-1), before);
  EXPECT_EQ(held.missed(NAN), before);
  EXPECT_EQ(held.stepped({{2, 0, 0}, {}}, 0), before);
  held.reset();
  EXPECT_EQ(held.missed(1e-3), Wrench{});
  EXPECT_EQ(test::error_of([] { WrenchExtrapolator h({.fade = 0}); }), "fade must be positive");
  EXPECT_EQ(test::error_of([] { WrenchExtrapolator h({.ahead = 1, .fade = 0.1}); }), "ahead must be at most fade");
}

}  // namespace
}  // namespace riffler::haptics::wrench_extrapolator_test
