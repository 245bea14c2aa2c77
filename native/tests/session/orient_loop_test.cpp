// Orienting a tool by hand through the whole stack, on a virtual clock.
#include "riffler/session/orient_loop.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "geom/math.hpp"
#include "pen/arms/pens.hpp"
#include "riffler/dexel/volume.hpp"
#include "session/orient_bench.hpp"
#include "support/allocations.hpp"
#include "support/effort.hpp"
#include "support/error_of.hpp"

namespace riffler::session::orient_loop_test {
namespace {

using test::edge_path;
using test::leaning;

const collide::Collider& part() {
  static const collide::Collider made(test::corner());
  return made;
}

struct OrientBench : test::PenBench {
  explicit OrientBench(pen::HandPath path, OrientSettings settings = {}, double angle = 0.5,
                       const collide::Collider& obstacles = part())
      : PenBench(std::move(path)),
        loop((settings.passivity = model.passivity(), settings), test::wide_shank(),
             PathGuide(edge_path(), test::wide_shank(), 18, leaning(angle), settings.slides), obstacles,
             model.capability(), false) {
    drive(loop);
  }

  template <class Visit>
  void run(double seconds, const Visit& visit) {
    ticks<OrientTick>(loop, seconds, visit);
  }

  OrientLoop loop;
};

double angle_of(const Vec3& axis) {
  return std::atan2(axis.y, axis.z);
}

/// From a second on the hand turns about the edge, towards the wall, by `angle` at 0.5 rad/s, and moves by `shift`.
pen::HandPath turning_hand(double angle, const Vec3& shift = {}, std::uint32_t buttons = 0) {
  return [home = test::pen_home(), angle, shift, buttons](double t) {
    const double s = std::clamp((t - 1) * 0.5 / std::abs(angle), 0.0, 1.0);
    pen::HandWish wish{.pose = home};
    wish.pose.axis = geom::rotate_about(home.axis, {1, 0, 0}, s * angle);
    wish.pose.tip += s * shift;
    wish.buttons = t > 1 ? buttons : 0;
    return wish;
  };
}

/// The grip's turn about x since the start, as the hand made it.
struct Turned {
  double angle = 0;
  void operator()(const OrientTick& tick) {
    if (std::exchange(begun_, true))
      angle = angle_between(first_, tick.grip.axis);
    else
      first_ = tick.grip.axis;
  }

 private:
  static double angle_between(const Vec3& a, const Vec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
  }
  bool begun_ = false;
  Vec3 first_;
};

TEST(OrientLoop, TheAxisFollowsTheHandAndTheCutterStaysOnThePath) {
  OrientSettings settings;
  settings.slides = false;
  OrientBench bench(turning_hand(-0.3, {4, 2, 1}), settings);
  OrientTick last;
  Turned turned;
  double off = 0, torque = 0;
  bench.run(3, [&](const OrientTick& tick) {
    off = std::max(off, glm::length(tick.tool.tip + test::kBallRadius * tick.tool.axis - Vec3(20, 3, 3)));
    if (tick.time > 0.5) torque = std::max(torque, glm::length(tick.wrench.torque));
    turned(last = tick);
  });
  EXPECT_LT(off, 1e-9);
  EXPECT_EQ(last.state, haptics::ForceState::Active);
  // The tool has turned as the hand has, up to the tremor of a hand.
  EXPECT_NEAR(std::abs(angle_of(last.tool.axis) - 0.5), turned.angle, 0.02);
  EXPECT_GT(turned.angle, 0.2);
  EXPECT_LT(torque, 20);  // nothing is hit
  EXPECT_FALSE(last.missed);
}

TEST(OrientLoop, TheShankStopsAtTheWallAndTheHandFeelsIt) {
  const double stop = test::touching_angle();
  EXPECT_NEAR(stop * kRadian, 6.64, 0.01);
  OrientBench bench(turning_hand(0.9));
  OrientTick last;
  double deepest = 0, least = 0;
  Vec3 torque;
  bench.run(5, [&](const OrientTick& tick) {
    deepest = std::max(deepest, tick.depth), least = std::min(least, tick.energy);
    torque = tick.wrench.torque, last = tick;
  });
  EXPECT_NEAR(angle_of(last.tool.axis), stop, 0.02);  // the wall yields a little
  EXPECT_LT(deepest, 0.3);
  EXPECT_EQ(last.touch, collide::Touch::Shank);
  EXPECT_LT(torque.x, -100);  // against the hand's turn about +x
  EXPECT_GE(least, 0);
  // It comes back at once when the hand does.
  bench.pen->hand().follow(
      [axis = last.tool.axis, home = test::pen_home()](double) { return pen::HandWish{.pose = home}; });
  bench.run(2, [&](const OrientTick& tick) { last = tick; });
  EXPECT_NEAR(angle_of(last.tool.axis), 0.5, 0.05);
  EXPECT_LT(last.depth, 0.05);
}

TEST(OrientLoop, TheToolSlidesWithTheHandAlongThePathToItsEnd) {
  OrientBench bench(turning_hand(-0.1, {10, 3, 0}));
  OrientTick last;
  bench.run(3, [&](const OrientTick& tick) { last = tick; });
  EXPECT_NEAR(last.station, 28, 0.6);
  EXPECT_LT(glm::length(last.wrench.force), 1.6);  // what draws the hand to the path is weak
  bench.pen->hand().follow(turning_hand(-0.1, {60, 0, 0}));
  bench.run(3, [&](const OrientTick& tick) { last = tick; });
  EXPECT_NEAR(last.station, 36, 1e-3);
}

TEST(OrientLoop, EachPressIsReportedOnceWithThePlaceAndAxisThatTheUserSees) {
  OrientBench bench([home = test::pen_home()](double t) {
    pen::HandWish wish{.pose = home};
    // Held at the start: no press. Then the first button twice, and the second.
    const bool first = t < 0.3 || (t > 1 && t < 1.4) || (t > 1.6 && t < 1.7), second = t > 1.2 && t < 1.5;
    wish.buttons = (first ? 1U : 0U) | (second ? 2U : 0U);
    return wish;
  });
  OrientTick last;
  bench.run(2.5, [&](const OrientTick& tick) { last = tick; });
  std::vector<KeyPress> presses;
  for (KeyPress press; bench.loop.take(press);) presses.push_back(press);
  ASSERT_EQ(presses.size(), 3U);
  EXPECT_FALSE(presses[0].deletes);
  EXPECT_TRUE(presses[1].deletes);
  EXPECT_FALSE(presses[2].deletes);
  for (const KeyPress& press : presses) {
    EXPECT_NEAR(press.station, last.station, 0.2);
    EXPECT_LT(glm::length(press.axis - last.tool.axis), 0.02);
  }
  EXPECT_EQ(bench.loop.dropped_presses(), 0U);
}

/// Whatever goes wrong: the force is gone within the time that the sculpting loop has for it, no press counts, and the
/// tool stands where it was.
TEST(OrientLoop, EveryFaultRemovesTheForceAndLeavesTheTool) {
  const std::vector<std::pair<const char*, std::function<void(OrientBench&)>>> faults{
      {"unplugged", [](OrientBench& b) { b.pen->unplug(); }},
      {"processor stands", [](OrientBench& b) { b.pen->halt(150'000); }},
      {"no reports", [](OrientBench& b) { b.pen->cable().set({.lost = 1}); }},
      {"jump", [](OrientBench& b) { b.pen->on_sense = [](riffler_pen_sensors& s) { s.counters[1] += 5000; }; }},
      {"stopped", [](OrientBench& b) { b.pen->on_sense = [](riffler_pen_sensors& s) { s.stopped = 1; }; }},
      {"motor driver", [](OrientBench& b) { b.pen->on_sense = [](riffler_pen_sensors& s) { s.driver_faults = 4; }; }},
  };
  for (const auto& [name, begin] : faults) {
    if (test::kSanitized && &begin != &faults.front().second && &begin != &faults.back().second) continue;
    OrientBench bench(turning_hand(0.9, {}, 0));
    OrientTick last;
    bench.run(4, [&](const OrientTick& tick) { last = tick; });
    ASSERT_GT(glm::length(last.wrench.torque), 100) << name;
    const Pose stood = last.tool;
    begin(bench);
    bench.run(0.03, [&](const OrientTick&) {});
    EXPECT_FALSE(bench.pen->pushes()) << name;
    double pushed = 0;
    bench.run(0.1, [&](const OrientTick& tick) {
      pushed = std::max(pushed, glm::length(tick.wrench.force) + glm::length(tick.wrench.torque));
      EXPECT_LT(glm::length(tick.tool.axis - stood.axis), 0.05) << name;
    });
    EXPECT_EQ(pushed, 0) << name;
    KeyPress press;
    EXPECT_FALSE(bench.loop.take(press)) << name;
  }
}

/// Without torque the contact's force is rendered: away from the wall.
TEST(OrientLoop, APenWithoutTorqueGetsTheForceOfTheContact) {
  pen::DeviceCapability device = pen_capability(pen::load_pen("riffler"));
  for (const pen::Coordinate c : {pen::Coordinate::A, pen::Coordinate::B, pen::Coordinate::C}) device[c].pushes = false;
  OrientLoop loop({}, test::wide_shank(), PathGuide(edge_path(), test::wide_shank(), 18, leaning(0.3), true), part(),
                  device, false);
  Wrench out;
  OrientTick tick;
  for (int k = 0; k < 2500; ++k) {
    pen::PenSample sample;
    sample.pose.axis = leaning(0.3 - std::min(0.6, 4e-4 * k));
    sample.sequence = static_cast<std::uint64_t>(k) + 1, sample.time = 1e-3 * k;
    sample.homed = sample.powered = true;
    out = loop.step(sample, 1e-3 * k, k ? 1e-3 : 0).wrench();
    while (loop.take(tick)) {
    }
  }
  EXPECT_EQ(out.torque, Vec3(0));
  EXPECT_GT(out.force.y, 1);
  EXPECT_GT(out.force.y, 5 * std::abs(out.force.x));
}

TEST(OrientLoop, AStepInContactAllocatesNothing) {
  OrientBench bench(turning_hand(0.9));
  bench.run(4, [](const OrientTick&) {});
  pen::PenSample sample;
  sample.pose = bench.pen->arms().posture().pose;
  sample.homed = sample.powered = true;
  const long before = test::allocations();
  for (int k = 0; k < 200; ++k) {
    sample.time = bench.end + 1e-3 * k, sample.sequence = 100'000 + static_cast<std::uint64_t>(k);
    bench.loop.step(sample, sample.time, 1e-3);
  }
  EXPECT_EQ(test::allocations() - before, 0);
}

/// Two minutes of planning by feel next to a clamp: random turns and slides into part and fixture. The account of
/// energy never falls below zero, and no tick leaves the tool deeper than the walls yield.
TEST(OrientLoop, MinutesOfPlanningByFeelGiveTheHandNoEnergy) {
  std::vector<Volume> clamp;
  clamp.push_back(Volume::block({{{10, 14, 8}, {30, 30, 40}}, 0.5, "xyz"}));
  const collide::Collider obstacles(test::corner(), std::move(clamp));
  OrientBench bench(
      [home = test::pen_home()](double t) {
        const double s = std::max(0.0, t - 1);
        pen::HandWish wish{.pose = home};
        wish.pose.tip += Vec3(12 * std::sin(0.7 * s), 3 * std::sin(1.9 * s), 3 * std::sin(2.3 * s));
        const Vec3 turn(0.7 * std::sin(1.1 * s) + 0.1 * std::sin(7 * s), 0.4 * std::sin(0.8 * s), 0);
        wish.pose.axis = geom::rotate_by(home.axis, turn);
        wish.buttons = std::fmod(s, 1.7) < 0.2 ? 1 : 0;
        return wish;
      },
      {}, 0.15, obstacles);
  double least = 0, deepest = 0;
  int ticks = 0, touched = 0, through = 0, lied = 0;
  const collide::Assembly assembly(test::wide_shank());
  bench.run(test::kSanitized ? 10 : 60, [&](const OrientTick& tick) {
    least = std::min(least, tick.energy);
    if (++ticks % (test::kSanitized ? 16 : 4) == 0) {
      const double depth = -obstacles.nearest(assembly, tick.tool).distance;
      deepest = std::max(deepest, depth), lied += depth > tick.depth + 1e-6;
    }
    touched += tick.touch.has_value() && *tick.touch != collide::Touch::Cutter;
    through += !geom::finite(tick.tool.tip) || tick.missed;
  });
  EXPECT_GE(least, 0);
  EXPECT_GT(touched, test::kSanitized ? 100 : 2500);
  EXPECT_EQ(through, 0);
  EXPECT_LT(deepest, 1.2);
  EXPECT_EQ(lied, 0);  // the reported depth is a bound
  int presses = 0;
  for (KeyPress press; bench.loop.take(press);) ++presses;
  EXPECT_GT(presses, 3);
}

TEST(OrientLoop, NamesSettingsThatContradictOneAnother) {
  OrientSettings settings;
  settings.set_mask = 3;
  EXPECT_NE(test::error_of([&] { settings.validate(); }).find("delete_mask"), std::string::npos);
  settings = {};
  settings.workspace.clutch_mask = 1;
  EXPECT_NE(test::error_of([&] { settings.validate(); }).find("clutch_mask"), std::string::npos);
  settings = {};
  settings.step.parts = 2;
  EXPECT_NE(test::error_of([&] { settings.validate(); }).find("parts"), std::string::npos);
}

}  // namespace
}  // namespace riffler::session::orient_loop_test
