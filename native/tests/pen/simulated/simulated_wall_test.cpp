// A wall in the host and a hand that presses on it, through the whole stack: what the motors give is never more than
// what the hand gave, with the passivity controller on; and without it, a wall too stiff for the latency does give.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geom/math.hpp"
#include "pen/arms/joint_losses.hpp"
#include "pen/arms/pens.hpp"
#include "pen/simulated/simulated_bench.hpp"
#include "riffler/haptics/limits.hpp"
#include "riffler/haptics/passivity.hpp"
#include "riffler/pen/arms/motors.hpp"
#include "riffler/pen/passivity_settings.hpp"
#include "support/effort.hpp"

namespace riffler::pen::simulated_wall_test {
namespace {

using test::SimulatedBench;

struct Wall {
  double stiffness;         // N/mm
  bool controlled;          // by passivity
  std::int64_t jitter;      // µs
  bool applied;             // the account is kept by what the motors had, or by what was asked for
  double latency = 2e-3;    // s: that the controller knows of
  bool identified = false;  // the account is credited with what the joints' friction takes
};

struct Touch {
  double gained = 0;       // N·mm: the most that the wall was ahead of the hand, as the true motion of the arms has it
  double reached = 0;      // N·mm: the same less what friction took of it: the most that the hand could get
  double account = 1e300;  // the controller's least
  double deepest = 0, speed = 0;  // mm, mm/s root mean square of the last second
  std::uint64_t trips = 0;
};

/// z below the home posture is wall. The hand goes down on it, presses, and comes up again, six times in 12 s.
Touch touch(const Wall& wall) {
  SimulatedPenSettings settings;
  settings.cable.jitter_us = wall.jitter;
  const Pose home = SimulatedPen(settings).arms().posture().pose;
  const double surface = home.tip.z - 2;
  SimulatedBench b(settings, [home](double t) {
    HandWish wish{.pose = home};
    wish.pose.tip.z -= 3 * (1 - std::cos(kPi * std::max(0.0, t - 1)));
    return wish;
  });
  const PenKinematics host(load_pen("riffler"));
  const DeviceCapability device = pen_capability(host.geometry());
  const haptics::LimitSettings limits;
  PenGeometry known = host.geometry();
  if (wall.identified) {
    known.uncertainty.emplace();
    for (std::size_t k = 0; k < kPenChannels; ++k)
      known.uncertainty->coulomb[k] = 0.01 * known.channels[k].coulomb,
      known.uncertainty->viscous[k] = 0.02 * known.channels[k].viscous;
  }
  JointLosses losses(known, {});
  haptics::PassivitySettings counted = passivity_settings(known);
  counted.latency = wall.latency;
  if (wall.applied && wall.latency > 0) counted.device_rate = slowest_change(known, 100);
  haptics::Passivity passivity(counted);
  Pose last = home;
  Wrench held, rates;
  Touch out;
  b.step.law = [&](const PenSample& s, double, double dt) {
    const Twist moved{s.pose.tip - last.tip, turn_between(last.axis, s.pose.axis)};
    last = s.pose;
    const double dissipated = losses.add(s.counts, s.time);
    if (!s.homed) return Wrench{};
    passivity.observe(wall.applied ? s.applied : held, moved, dt, dissipated);
    out.account = std::min(out.account, passivity.energy());
    const double depth = surface - s.pose.tip.z;
    out.deepest = std::max(out.deepest, depth);
    Wrench w{{0, 0, std::max(0.0, wall.stiffness * depth)}, {}};
    const haptics::Capability push = pushed(device, s.pose.axis);
    w = rates = limited(limits, push, rates, w, {s.velocity, s.turning}, dt);
    if (wall.controlled) w = passivity.control(w, push);
    return magnitude_gain(limits, w) * w;
  };
  b.step.after = [&](const Wrench& w) { held = w; };
  double square = 0;
  long late = 0;
  b.pen->on_turn = [&] {
    const PenEnergy energy = b.pen->arms().energy();
    out.gained = std::max(out.gained, energy.motors);
    out.reached = std::max(out.reached, energy.motors - energy.lost);
    if (b.pen->time_us() > 11'000'000) {
      const double v = b.pen->arms().speed().twist.linear.z;
      square += v * v, ++late;
    }
  };
  b.run(12);
  out.speed = std::sqrt(square / static_cast<double>(late));
  out.trips = b.step.safety.log().count();
  return out;
}

/// No more than the reserve and, where the cable's delay exceeds the known latency, what is still on it.
TEST(SimulatedPenWall, MotorsNeverGiveMoreThanTheyTookWithTheControllerOnTheirCommands) {
  for (const double stiffness : {1.0, 3.0, 10.0, 30.0}) {
    if (test::kSanitized && stiffness < 30) continue;
    const Touch prompt = touch({stiffness, true, 0, true}), late = touch({stiffness, true, 1500, true});
    EXPECT_LT(prompt.gained, 1.2) << stiffness;
    EXPECT_LT(prompt.deepest, 1.4) << stiffness << ": the wall yielded";
    EXPECT_LT(late.gained, 3) << stiffness;
    EXPECT_GT(std::min(prompt.account, late.account), 0) << stiffness;
    EXPECT_EQ(prompt.trips + late.trips, 0U);
  }
}

/// Friction that was identified pays for hard walls: the hand gets as little as before, and they yield less.
TEST(SimulatedPenWall, IdentifiedFrictionMakesHardWallsHarderAndGivesTheHandNothing) {
  for (const double stiffness : {3.0, 10.0, 30.0}) {
    if (test::kSanitized && stiffness < 30) continue;
    const Touch before = touch({stiffness, true, 0, true}), with = touch({stiffness, true, 0, true, 2e-3, true});
    EXPECT_LT(with.reached, 1.2) << stiffness;
    EXPECT_LT(with.deepest, before.deepest + 1e-3) << stiffness;
    EXPECT_GT(with.account, 0) << stiffness;
    EXPECT_EQ(with.trips, 0U);
  }
}

/// What is on the cable is not in the account yet. A controller that does not know of it runs into debts, and while
/// they are paid hard walls are not there.
TEST(SimulatedPenWall, AControllerThatDoesNotKnowTheLatencyRunsIntoDebt) {
  const Touch touched = touch({30, true, 0, true, 0});
  EXPECT_LT(touched.account, -0.3);
  EXPECT_GT(touched.deepest, 3);
}

TEST(SimulatedPenWall, WithoutTheControllerAStiffWallGivesMuchEnergy) {
  for (const double stiffness : {10.0, 30.0}) EXPECT_GT(touch({stiffness, false, 0, false}).gained, 100);
}

/// The controller leaves a wall unchanged that the pen bears by itself.
TEST(SimulatedPenWall, ASoftWallStaysUnchanged) {
  const Touch with = touch({1, true, 0, true}), without = touch({1, false, 0, true});
  EXPECT_EQ(with.gained, without.gained);
  EXPECT_EQ(with.deepest, without.deepest);
  EXPECT_LT(with.gained, 0.1);
}

/// Why samples carry what was applied: with what the host asked for, which the motors have a frame later, the account
/// stays above zero while the motors give hundreds of times the reserve.
TEST(SimulatedPenWall, AnAccountOfRequestedForcesIsWrongWithACable) {
  const Touch touched = touch({30, true, 0, false});
  EXPECT_GT(touched.account, 0);
  EXPECT_GT(touched.gained, 100);
}

}  // namespace
}  // namespace riffler::pen::simulated_wall_test
