#include "riffler/haptics/workspace.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "stress/random.hpp"
#include "support/allocations.hpp"
#include "support/error_of.hpp"

namespace riffler::haptics::workspace_test {
namespace {

const Vec3 kUp(0, 0, 1);

TEST(Workspace, ItsTargetNeverJumpsForAnyButtonOrSetting) {
  stress::Random random(1);
  Workspace workspace;
  const Pose start{{10, 20, 30}, glm::normalize(Vec3(1, 2, 3))};
  workspace.place(start);
  Pose grip{{-5, 0, 7}, kUp}, last = start;
  EXPECT_LT(glm::length(workspace.target(grip, 1).tip - start.tip), 1e-12);
  std::uint32_t buttons = 1;
  double scale = 1, pivot = 0;
  for (int k = 0; k < 50'000; ++k) {
    const Vec3 way = random.uniform(0, 0.1) * random.direction();
    const double turn = random.uniform(0, 0.01);
    grip.tip += way;
    grip.axis = glm::normalize(grip.axis + turn * random.square_to(grip.axis));
    if (random.one_in(40)) buttons ^= 2;
    if (random.one_in(100)) {
      WorkspaceSettings s = workspace.settings();
      s.scale = scale = random.power_of_ten(-1, 1);
      s.pivot = pivot = random.uniform(-50, 200);
      s.turn[2] = random.direction(), s.turn[0] = random.square_to(s.turn[2]);
      s.turn[1] = glm::cross(s.turn[2], s.turn[0]);
      workspace.set(s);
    }
    const Pose now = workspace.target(grip, buttons);
    const Vec3 led = now.tip + pivot * now.axis, led_before = last.tip + pivot * last.axis;
    ASSERT_LE(glm::length(led - led_before), scale * glm::length(way) + 1e-9) << k;
    ASSERT_LE(glm::length(now.axis - last.axis), turn * 1.001 + 1e-9) << k;
    ASSERT_NEAR(glm::length(now.axis), 1, 1e-12);
    if (buttons & workspace.settings().clutch_mask) {
      EXPECT_LT(glm::length(now.tip - last.tip), 1e-9);
      EXPECT_LT(glm::length(now.axis - last.axis), 1e-9);
    }
    last = now;
  }
}

TEST(Workspace, FollowsTheGripTurnedAndScaled) {
  WorkspaceSettings s;
  s.scale = 0.25;
  s.turn = Mat3(Vec3(0, 1, 0), Vec3(-1, 0, 0), Vec3(0, 0, 1));
  Workspace workspace(s);
  workspace.place({{1, 2, 3}, kUp});
  workspace.target({{0, 0, 0}, kUp}, 0);
  const Pose now = workspace.target({{4, 0, 8}, glm::normalize(Vec3(0.1, 0, 1))}, 0);
  EXPECT_LT(glm::length(now.tip - Vec3(1, 3, 5)), 1e-12);
  EXPECT_LT(glm::length(now.axis - glm::normalize(Vec3(0, 0.1, 1))), 1e-12);
}

TEST(Workspace, AHandThatTurnsTurnsTheToolAboutThePivot) {
  WorkspaceSettings s;
  s.pivot = 40, s.scale = 0.5;
  Workspace workspace(s);
  const Pose start{{1, 2, 3}, kUp};
  workspace.place(start);
  workspace.target({{7, 7, 7}, kUp}, 0);
  for (int k = 1; k <= 20; ++k) {
    const double angle = 0.05 * k;
    const Pose now = workspace.target({{7, 7, 7}, {std::sin(angle), 0, std::cos(angle)}}, 0);
    const Vec3 expected = Vec3(1, 2, 43) - 40.0 * Vec3(std::sin(angle), 0, std::cos(angle));
    EXPECT_LT(glm::length(now.tip - expected), 1e-9);
  }
  const Pose moved = workspace.target({{9, 7, 7}, {std::sin(1.0), 0, std::cos(1.0)}}, 0);
  EXPECT_LT(glm::length(moved.tip + 40.0 * moved.axis - Vec3(2, 2, 43)), 1e-9) << "and moves it by the scale";
}

TEST(Workspace, TheHandsTorqueIsAboutThePivot) {
  WorkspaceSettings s;
  s.pivot = 40;
  Workspace workspace(s);
  workspace.place({{1, 2, 3}, kUp});
  workspace.target({{0, 0, 0}, kUp}, 0);
  // A force of 2 N along x at the tip turns the hand about y: arm (0, 0, -40) times force.
  const Wrench felt = workspace.to_grip({{2, 0, 0}, {0, 0, 5}});
  EXPECT_LT(glm::length(felt.force - Vec3(2, 0, 0)), 1e-12);
  EXPECT_LT(glm::length(felt.torque - Vec3(0, -80, 5)), 1e-12);
  const Wrench along = workspace.to_grip({{0, 0, 3}, {}});
  EXPECT_EQ(glm::length(along.torque), 0) << "a force along the axis passes through the pivot";
}

TEST(Workspace, ADeviceInThePartsFrameLeadsTheTip) {
  WorkspaceSettings s;
  s.pivot = 40;
  EXPECT_EQ(s.for_device(true).pivot, 0);
  EXPECT_EQ(s.for_device(false).pivot, 40);
}

TEST(Workspace, TheHandsPowerEqualsTheTargets) {
  stress::Random random(2);
  for (int k = 0; k < 1000; ++k) {
    WorkspaceSettings s;
    s.scale = random.power_of_ten(-1, 1);
    s.pivot = random.one_in(3) ? 0 : random.uniform(-100, 300);
    s.turn[2] = random.direction(), s.turn[0] = random.square_to(s.turn[2]);
    s.turn[1] = glm::cross(s.turn[2], s.turn[0]);
    Workspace workspace(s);
    workspace.place({Vec3(0), random.direction()});
    workspace.target({Vec3(0), random.direction()}, 0);
    const Wrench w{random.direction(), 30.0 * random.direction()};
    const Twist t{100.0 * random.direction(), random.direction()};
    EXPECT_NEAR(power(workspace.to_grip(w), t), power(w, workspace.to_target(t)), 1e-8);
  }
}

TEST(Workspace, TheClutchAndTheDeadManSwitchRemoveTheForce) {
  Workspace workspace;
  workspace.place({});
  workspace.target({}, 1);
  EXPECT_EQ(workspace.to_grip({{1, 0, 0}, {}}).force.x, 1);
  workspace.target({}, 3);
  EXPECT_EQ(workspace.to_grip({{1, 0, 0}, {}}), Wrench{});
  EXPECT_EQ(workspace.to_target({{1, 0, 0}, {}}).linear, Vec3(0));
  EXPECT_TRUE(workspace.dead_man(1));
  EXPECT_FALSE(workspace.dead_man(2));
  WorkspaceSettings s;
  s.dead_man_mask = 0;
  EXPECT_TRUE(Workspace(s).dead_man(0));
}

TEST(Workspace, OppositeAxesAndInvalidGripsGiveFiniteTargets) {
  Workspace workspace;
  workspace.place({{1, 2, 3}, -kUp});
  EXPECT_LT(glm::length(workspace.target({{0, 0, 0}, kUp}, 0).axis + kUp), 1e-12);
  const Pose last = workspace.target({{1e5, -1e5, 1e5}, kUp}, 0);
  for (const Pose& bad : {Pose{{NAN, 0, 0}, kUp}, Pose{{0, 0, 0}, {0, 0, 0}}, Pose{{0, 0, 0}, {0, NAN, 1}}})
    EXPECT_EQ(workspace.target(bad, 0).tip, last.tip);
  const long before = test::allocations();
  workspace.target({{1, 2, 3}, kUp}, 2), workspace.target({{1, 2, 3}, kUp}, 0);
  EXPECT_EQ(test::allocations(), before);
}

TEST(Workspace, SettingsNameTheFieldThatIsWrong) {
  const auto message = [](auto change) {
    WorkspaceSettings s;
    change(s);
    return test::error_of([&] { Workspace workspace(s); });
  };
  EXPECT_EQ(message([](auto& s) { s.scale = 0; }), "scale must be positive");
  EXPECT_EQ(message([](auto& s) { s.pivot = NAN; }), "pivot must be at most 1000 mm");
  EXPECT_EQ(message([](auto& s) { s.turn[0].x = 2; }), "turn must be orthonormal and right-handed");
  EXPECT_EQ(message([](auto& s) { s.turn = -s.turn; }), "turn must be orthonormal and right-handed");
  EXPECT_EQ(message([](auto& s) { s.turn[0].x = NAN; }), "turn must be orthonormal and right-handed");
  EXPECT_EQ(message([](auto& s) { s.clutch_mask = 1; }), "clutch_mask must share no button with dead_man_mask");
}

}  // namespace
}  // namespace riffler::haptics::workspace_test
