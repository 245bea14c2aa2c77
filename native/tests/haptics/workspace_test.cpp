#include "riffler/haptics/workspace.hpp"

#include <gtest/gtest.h>

#include "stress/random.hpp"
#include "support/allocations.hpp"
#include "support/error_of.hpp"

namespace riffler::haptics::workspace_test {
namespace {

const Vec3 kUp(0, 0, 1);

TEST(Workspace, ItsTargetNeverJumpsWhateverIsPressedOrSet) {
  stress::Random random(1);
  Workspace workspace;
  const Pose start{{10, 20, 30}, glm::normalize(Vec3(1, 2, 3))};
  workspace.place(start);
  Pose grip{{-5, 0, 7}, kUp}, last = start;
  EXPECT_LT(glm::length(workspace.target(grip, 1).tip - start.tip), 1e-12);
  std::uint32_t buttons = 1;
  double scale = 1;
  for (int k = 0; k < 50'000; ++k) {
    const Vec3 way = random.uniform(0, 0.1) * random.direction();
    const double turn = random.uniform(0, 0.01);
    grip.tip += way;
    grip.axis = glm::normalize(grip.axis + turn * random.square_to(grip.axis));
    if (random.one_in(40)) buttons ^= 2;
    if (random.one_in(100)) {
      WorkspaceSettings s = workspace.settings();
      s.scale = scale = random.power_of_ten(-1, 1);
      s.turn[2] = random.direction(), s.turn[0] = random.square_to(s.turn[2]);
      s.turn[1] = glm::cross(s.turn[2], s.turn[0]);
      workspace.set(s);
    }
    const Pose now = workspace.target(grip, buttons);
    ASSERT_LE(glm::length(now.tip - last.tip), scale * glm::length(way) + 1e-9) << k;
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

TEST(Workspace, TheHandsPowerIsTheTargets) {
  stress::Random random(2);
  for (int k = 0; k < 1000; ++k) {
    WorkspaceSettings s;
    s.scale = random.power_of_ten(-1, 1);
    s.turn[2] = random.direction(), s.turn[0] = random.square_to(s.turn[2]);
    s.turn[1] = glm::cross(s.turn[2], s.turn[0]);
    Workspace workspace(s);
    workspace.place({Vec3(0), random.direction()});
    workspace.target({Vec3(0), random.direction()}, 0);
    const Wrench w{random.direction(), 30.0 * random.direction()};
    const Twist t{100.0 * random.direction(), random.direction()};
    EXPECT_NEAR(power(workspace.to_grip(w), t), power(w, workspace.to_target(t)), 1e-9);
  }
}

TEST(Workspace, TheClutchTakesTheForceAndTheDeadManIsAsked) {
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

TEST(Workspace, OppositeAxesAndGripsThatAreNoneAreNoTrouble) {
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
  EXPECT_EQ(message([](auto& s) { s.turn[0].x = 2; }), "turn must be orthonormal and right-handed");
  EXPECT_EQ(message([](auto& s) { s.turn = -s.turn; }), "turn must be orthonormal and right-handed");
  EXPECT_EQ(message([](auto& s) { s.turn[0].x = NAN; }), "turn must be orthonormal and right-handed");
  EXPECT_EQ(message([](auto& s) { s.clutch_mask = 1; }), "clutch_mask must share no button with dead_man_mask");
}

}  // namespace
}  // namespace riffler::haptics::workspace_test
