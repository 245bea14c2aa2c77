#include "riffler/haptics/limits.hpp"

#include <gtest/gtest.h>

#include "stress/random.hpp"
#include "support/error_of.hpp"

namespace riffler::haptics::limits_test {
namespace {

Wrench random_wrench(stress::Random& random, double size) {
  return {random.uniform(0, size) * random.direction(), random.uniform(0, 60 * size) * random.direction()};
}

/// Whether w is factor · of with 0 ≤ factor ≤ 1.
void expect_shrunk(const Wrench& w, const Wrench& of) {
  double dot = 0, square = 0;
  for (int k = 0; k < kCoordinates; ++k) dot += w[k] * of[k], square += of[k] * of[k];
  const double factor = square > 0 ? dot / square : 0;
  EXPECT_GE(factor, 0);
  EXPECT_LE(factor, 1 + 1e-12);
  for (int k = 0; k < kCoordinates; ++k) EXPECT_NEAR(w[k], factor * of[k], 1e-9 * (1 + std::abs(of[k])));
}

/// Without rates there is nothing to remember.
LimitSettings without_rates() {
  LimitSettings s;
  s.rate = {1e12, 1e12};
  return s;
}

TEST(HapticLimits, KeepTheDirectionInAllSixCoordinates) {
  stress::Random random(1);
  const LimitSettings s = without_rates();
  for (int n = 0; n < 5000; ++n) {
    const Wrench wanted = random_wrench(random, std::exp(random.uniform(-3, 6)));
    const Twist grip{random.uniform(0, 1100) * random.direction(), random.uniform(0, 21) * random.direction()};
    const Wrench w = limited(s, {}, {}, wanted, grip, 1e-3);
    expect_shrunk(w, wanted);
    EXPECT_LE(glm::length(w.force), s.wrench.linear * (1 + 1e-12));
    EXPECT_LE(glm::length(w.torque), s.wrench.angular * (1 + 1e-12));
    EXPECT_LE(power(w, grip), s.power * (1 + 1e-12));
  }
}

TEST(HapticLimits, KeepWrenchesWithinThem) {
  const Wrench wanted{{1, 2, 3}, {10, 20, 30}};
  LimitReport report;
  const Twist grip{{1, 2, 3}, {0.1, 0, 0}};
  EXPECT_EQ(limited(without_rates(), {}, {}, wanted, grip, 1e-3, &report), wanted);
  EXPECT_EQ(report.speed, 1);
  EXPECT_EQ(report.magnitude, 1);
  EXPECT_EQ(report.power, 1);
  EXPECT_FALSE(report.slewed);
  EXPECT_EQ(report.unrendered, Wrench{});
}

TEST(HapticLimits, ChangeByNoMoreThanTheRatesOrShrink) {
  stress::Random random(2);
  const LimitSettings s;
  Wrench previous;
  for (int n = 0; n < 20000; ++n) {
    const double dt = random.one_in(10) ? 0 : random.uniform(1e-4, 4e-3);
    const Wrench wanted = random_wrench(random, random.one_in(4) ? 0 : 20);
    const Twist grip{random.uniform(0, 200) * random.direction(), {}};  // full force at this speed
    LimitReport report;
    const Wrench w = limited(s, {}, previous, wanted, grip, dt, &report);
    if (report.power == 1) {
      EXPECT_LE(glm::length(w.force - previous.force), s.rate.linear * dt + 1e-12);
      EXPECT_LE(glm::length(w.torque - previous.torque), s.rate.angular * dt + 1e-9);
    } else {
      expect_shrunk(w, slewed(s, previous, magnitude_gain(s, wanted) * wanted, dt));
    }
    EXPECT_LE(glm::length(w.force), s.wrench.linear * (1 + 1e-12));
    EXPECT_LE(glm::length(w.torque), s.wrench.angular * (1 + 1e-12));
    previous = w;
  }
}

TEST(HapticLimits, ReachASteadyWrenchOnAStraightLine) {
  const LimitSettings s;
  const Wrench wanted{{0, 0, 5}, {100, 0, 0}};
  Wrench w;
  int ticks = 0;
  for (; !(w == wanted) && ticks < 1000; ++ticks) {
    w = limited(s, {}, w, wanted, {}, 1e-3);
    EXPECT_NEAR(w.torque.x * 5, w.force.z * 100, 1e-9);
  }
  EXPECT_EQ(ticks, 3);  // 5 N at 2 N a tick
}

TEST(HapticLimits, NoTimeMeansNoChange) {
  const LimitSettings s;
  const Wrench before{{1, 0, 0}, {}};
  for (const double dt : {0.0, -1.0}) EXPECT_EQ(limited(s, {}, before, {{0, 3, 0}, {}}, {}, dt), before);
}

TEST(HapticLimits, SpeedScalesDownInAStraightLineToNothing) {
  const LimitSettings s;
  EXPECT_EQ(speed_gain(s, {{300, 0, 0}, {}}), 1);
  EXPECT_DOUBLE_EQ(speed_gain(s, {{650, 0, 0}, {}}), 0.5);
  EXPECT_EQ(speed_gain(s, {{1000, 0, 0}, {}}), 0);
  EXPECT_DOUBLE_EQ(speed_gain(s, {{650, 0, 0}, {0, 0, 16.5}}), 0.25);
  EXPECT_EQ(speed_gain(s, {{NAN, 0, 0}, {}}), 0);
  // A force from before the grip was fast is cut at once, rates or not.
  EXPECT_EQ(limited(s, {}, {{5, 0, 0}, {}}, {{5, 0, 0}, {}}, {{0, 2000, 0}, {}}, 1e-3), Wrench{});
}

TEST(HapticLimits, OfZeroGiveZeroAndNoNan) {
  const Wrench wanted{{1, 2, 3}, {4, 5, 6}};
  for (int field = 0; field < 4; ++field) {
    LimitSettings s;
    if (field == 0) s.wrench.linear = 0;
    if (field == 1) s.wrench.angular = 0;
    if (field == 2) s.rate = {0, 0};
    if (field == 3) s.power = 0;
    const Wrench w = limited(s, {}, {}, wanted, {{1, 2, 3}, {}}, 1e-3);
    EXPECT_EQ(w, Wrench{}) << field;
    EXPECT_EQ(limited(s, {}, {}, {}, {}, 1e-3), Wrench{});
  }
}

TEST(HapticLimits, PassOnNanAndInfinity) {
  for (const double bad : {double(NAN), double(INFINITY), -double(INFINITY)})
    for (int k = 0; k < kCoordinates; ++k) {
      Wrench wanted{{1, 0, 0}, {0, 1, 0}};
      wanted[k] = bad;
      EXPECT_FALSE(finite(limited(LimitSettings{}, {}, {}, wanted, {}, 1e-3))) << k;
    }
}

TEST(HapticLimits, ReportTheRestThatTheDeviceCannotPush) {
  // A pen with its grip along (0, 0.6, 0.8): no torque about it.
  Capability pen;
  pen.push[5] = false;
  pen.axes[2] = Vec3(0, 0.6, 0.8), pen.axes[0] = Vec3(1, 0, 0), pen.axes[1] = glm::cross(pen.axes[2], pen.axes[0]);
  const Wrench wanted{{1, 2, 3}, {10, 60, 80}};
  LimitReport report;
  const Wrench w = limited(without_rates(), pen, {}, wanted, {}, 1e-3, &report);
  EXPECT_NEAR(glm::length(w.torque - Vec3(10, 0, 0)), 0, 1e-12);
  EXPECT_NEAR(glm::length(w.force - wanted.force), 0, 1e-12);
  EXPECT_NEAR(glm::length(report.unrendered.torque - Vec3(0, 60, 80)), 0, 1e-12);
  // When the grip turns, nothing of an older wrench is left about it.
  EXPECT_NEAR(glm::dot(limited(LimitSettings{}, pen, {{}, {0, 60, 80}}, {}, {}, 1e-5).torque, pen.axes[2]), 0, 1e-12);
}

TEST(HapticLimits, SettingsNameTheFieldThatIsWrong) {
  const auto message = [](auto change) {
    LimitSettings s;
    change(s);
    return test::error_of([&] { s.validate(); });
  };
  EXPECT_EQ(message([](auto& s) { s.wrench.linear = -1; }), "wrench.linear must not be negative");
  EXPECT_EQ(message([](auto& s) { s.rate.angular = NAN; }), "rate.angular must not be negative");
  EXPECT_EQ(message([](auto& s) { s.power = INFINITY; }), "power must not be negative");
  EXPECT_EQ(message([](auto& s) { s.no_force_at.linear = 100; }), "no_force_at.linear must be above full_speed.linear");
  EXPECT_NO_THROW(LimitSettings{}.validate());
}

}  // namespace
}  // namespace riffler::haptics::limits_test
