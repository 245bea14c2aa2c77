// A grip that the motors lead along a path, through the whole stack on a virtual clock.
#include "pen/pose_follower.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <thread>

#include "pen/arms/pens.hpp"
#include "pen/simulated/simulated_bench.hpp"
#include "support/error_of.hpp"

namespace riffler::pen::pose_follower_test {
namespace {

constexpr double kLetGo = 1.2;  // s after which the hand lets go

/// The pen with a follower as its step.
struct FollowerBench {
  FollowerBench(std::vector<FollowerKey> keys, const FollowerSettings& settings, HandPath path)
      : pen(std::make_shared<SimulatedPen>(SimulatedPenSettings(), std::move(path))),
        follower(load_pen("riffler"), std::move(keys), settings) {
    model.home();
  }
  void run(double seconds) {
    const double end = clock->now() + seconds;
    while (clock->now() < end) {
      if (answers) follower.alive();
      loop.tick();
      pen->advance(std::llround(1e6 * clock->now()));
    }
  }
  Pose pose() const { return pen->arms().posture().pose; }

  std::shared_ptr<SimulatedPen> pen;
  std::shared_ptr<SimulatedClock> clock = std::make_shared<SimulatedClock>();
  PoseFollower follower;
  std::unique_ptr<HidTransport> transport = std::make_unique<SimulatedTransport>(pen, clock);
  RifflerModel model{*transport};
  test::SimulatedConnector connector{pen, clock, model};
  DriverLoop loop{model, follower, connector, *clock, std::move(transport)};
  bool answers = true;
};

Pose home() {
  return SimulatedPen(SimulatedPenSettings()).arms().posture().pose;
}

HandPath lets_go() {
  return [home = home()](double t) { return HandWish{.pose = home, .grip = t < kLetGo ? 1.0 : 0.0}; };
}

/// Held for 1.5 s, 20 mm sideways and 0.3 rad aslant in a second, and held there.
std::vector<FollowerKey> aside() {
  FollowerKey start{0, home(), {}}, end = start;
  end.pose.tip += Vec3(5, 20, -5);
  end.pose.axis = glm::normalize(end.pose.axis + Vec3(0.3, 0, 0));
  FollowerKey begin = start;
  begin.time = 1.5, end.time = 2.5;
  return {start, begin, end};
}

TEST(PoseFollower, LeadsAFreeGripToTheEndOfItsPathAndHoldsIt) {
  const std::vector<FollowerKey> keys = aside();
  FollowerBench b(keys, {}, lets_go());
  b.run(0.3);
  EXPECT_EQ(b.follower.state(), FollowerState::Ramp);
  b.run(1.5);
  EXPECT_EQ(b.follower.state(), FollowerState::Moving);
  b.run(3);
  EXPECT_EQ(b.follower.state(), FollowerState::Holding);
  EXPECT_LT(glm::distance(b.pose().tip, keys.back().pose.tip), 1.5);
  EXPECT_LT(glm::distance(b.pose().axis, keys.back().pose.axis), 0.05);
  b.run(1);
  EXPECT_LT(b.pen->arms().energy().kinetic, 1e-6) << "it stands still";
}

TEST(PoseFollower, RecordsEveryReportOfTheMotionWithItsCurrents) {
  FollowerBench b(aside(), {}, lets_go());
  b.run(4.5);
  const std::vector<FollowerRecord> records = b.follower.records();
  ASSERT_NEAR(static_cast<double>(records.size()), 2500, 5);
  int pushed = 0;
  for (std::size_t k = 1; k < records.size(); ++k) {
    ASSERT_EQ(records[k].sequence, records[k - 1].sequence + 1);
    ASSERT_NEAR(records[k].time - records[k - 1].time, 1e-3, 2e-4);
    pushed += records[k].currents != decltype(records[k].currents){};
  }
  EXPECT_GT(pushed, 2000);
  const PenKinematics pen(load_pen("riffler"));
  EXPECT_LT(glm::distance(pen.posture(records.back().counts).pose.tip, aside().back().pose.tip), 2);
}

TEST(PoseFollower, NeverMovesFasterThanItsPath) {
  FollowerBench b(aside(), {}, lets_go());
  double fastest = 0;
  b.pen->on_turn = [&] { fastest = std::max(fastest, glm::length(b.pen->arms().speed().twist.linear)); };
  b.run(4.5);
  EXPECT_LT(fastest, 1.4 * 1.875 * std::sqrt(450.0));
}

TEST(PoseFollower, AStopRemovesTheForceAtOnceAndForGood) {
  FollowerBench b(aside(), {}, lets_go());
  b.run(2);
  ASSERT_TRUE(b.pen->pushes());
  b.follower.stop();
  b.run(0.01);
  EXPECT_FALSE(b.pen->pushes());
  EXPECT_EQ(b.follower.state(), FollowerState::Stopped);
  EXPECT_EQ(b.follower.reason(), FollowerStop::Asked);
  b.run(2);
  EXPECT_FALSE(b.pen->pushes());
}

/// A program that hangs must not leave the pen moving.
TEST(PoseFollower, StopsWhenItsProgramIsSilent) {
  FollowerSettings settings;
  settings.silence = 0.05;
  FollowerBench b(aside(), settings, lets_go());
  b.run(2);
  ASSERT_TRUE(b.pen->pushes());
  b.answers = false;
  std::this_thread::sleep_for(std::chrono::milliseconds(80));
  b.run(0.01);
  EXPECT_FALSE(b.pen->pushes());
  EXPECT_EQ(b.follower.reason(), FollowerStop::Silent);
}

/// A hand that drags the grip away, and a reversed motor, are not fought.
TEST(PoseFollower, StopsIfTheGripIsTooFarFromItsTarget) {
  FollowerBench b(aside(), {}, [home = home()](double t) {
    HandWish wish{.pose = home};
    wish.pose.tip.x += 40 * std::max(0.0, t - 1);
    return wish;
  });
  b.run(3);
  EXPECT_EQ(b.follower.reason(), FollowerStop::Astray);
  EXPECT_FALSE(b.pen->pushes());
}

TEST(PoseFollower, ATripOfTheGateEndsTheMotionEvenIfItHeals) {
  FollowerBench b(aside(), {}, lets_go());
  b.run(2);
  b.pen->halt(30'000);  // a device that is late: heals by itself
  b.run(2);
  EXPECT_EQ(b.follower.reason(), FollowerStop::Safety);
  EXPECT_NE(b.follower.cause(), haptics::Cause::None);
  EXPECT_FALSE(b.pen->pushes());
}

TEST(PoseFollower, CarriesAHungWeightThatItKnows) {
  const auto sag = [](double known) {
    FollowerSettings settings;
    settings.weight = known, settings.hook = 15;
    FollowerBench b({{0, home(), {}}, {4, home(), {}}}, settings, lets_go());
    b.pen->weight().hang(0.08, 15);
    b.run(3);
    EXPECT_EQ(b.follower.reason(), FollowerStop::None);
    return home().tip.z - b.pose().tip.z;
  };
  const double weight = 0.08 * kStandardGravity;
  EXPECT_LT(std::abs(sag(weight)), 1);
  EXPECT_GT(sag(0), 1.2);
}

/// Without a spring the extra wrench acts alone: a hand on its own spring yields by force over stiffness.
TEST(PoseFollower, PushesWithTheExtraWrenchAlone) {
  FollowerSettings settings;
  settings.coupling = {0, 0, 0, 0, 1, 0.5}, settings.gravity = 0;
  FollowerKey rest{0, home(), {}}, pushed{1, home(), {{0, 0, 1}, {}}}, held = pushed;
  held.time = 3;
  FollowerBench b({rest, pushed, held}, settings, hand_at(home()));
  b.run(3);
  // 0.5 N/mm, and friction of the arms, which holds some of it.
  EXPECT_NEAR(b.pose().tip.z - home().tip.z, 2, 0.8);
}

TEST(PoseFollower, RefusesInvalidPaths) {
  const PenGeometry pen = load_pen("riffler");
  const auto error = [&](std::vector<FollowerKey> keys, const FollowerSettings& settings = {}) {
    return test::error_of([&] { PoseFollower(pen, keys, settings); });
  };
  const FollowerKey key{0, home(), {}};
  FollowerKey bad = key;
  EXPECT_EQ(error({}), "keys: at least one is needed");
  EXPECT_EQ(error({key, key}), "keys, row 1: its time must be after that of the row before");
  bad.pose.tip.x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(error({bad}), "keys, row 0 must be finite");
  bad = key, bad.pose.axis *= 2;
  EXPECT_EQ(error({bad}), "keys, row 0: the axis must have the length 1");
  bad = key, bad.time = 4000;
  EXPECT_EQ(error({key, bad}), "keys: the path takes more than an hour");
  FollowerSettings settings;
  settings.weight = 30;
  EXPECT_NE(error({key}, settings).find("weight"), std::string::npos);
}

}  // namespace
}  // namespace riffler::pen::pose_follower_test
