// 3D Systems' Touch through a stub of its library, which has a thread of its own, with the faults of each.
#include "pen/library/hd_devices.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <string>

#include "pen/library/library_test.hpp"
#include "pen/library/stub_hd.hpp"
#include "riffler/pen/registry.hpp"
#include "support/stub_libraries.hpp"

namespace riffler::pen::hd_devices_test {
namespace {

using namespace std::chrono_literals;
using test::open_problem;
using test::StubHd;
using test::StubTouch;

class Touch : public ::testing::Test {
 protected:
  void SetUp() override { ::setenv("RIFFLER_LIBHD", test::stub_hd_path(), 1); }
  void TearDown() override { ::unsetenv("RIFFLER_LIBHD"); }

  bool push_until(Pen& pen, const std::function<bool()>& done, const Wrench& wrench = {{0, 0, 1}, {}}) {
    return test::push_until(pen, done, wrench, answer);
  }
  /// 1 N up: y of the library.
  bool pushes(Pen& pen) {
    return push_until(pen, [&] { return stub->force[1] > 0.95; });
  }

  const test::StubState<StubHd> state_;
  StubTouch* const stub = &state_->arms[0];
  PushAnswer answer;
};

TEST_F(Touch, ReadsInRifflersAxesAndPushesInTheLibrarys) {
  const auto pen = open_pen("touch");
  EXPECT_EQ(pen->kind(), "touch");
  stub->velocity[2] = 100;
  stub->buttons = 3;
  EXPECT_TRUE(push_until(*pen, [&] { return pen->newest().buttons == 3 && pen->newest().homed; }));
  const PenSample sample = pen->newest();
  EXPECT_LT(glm::length(sample.pose.tip - Vec3(10, -30, 20)), 1e-9);
  EXPECT_LT(glm::length(sample.velocity - Vec3(0, -100, 0)), 1e-9);
  EXPECT_LT(glm::length(sample.pose.axis - Vec3(0, -1, 0)), 1e-9) << "its end towards the user";
  // A quarter turn about the library's x: the stylus upright.
  const double upright[16] = {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1};
  for (int k = 0; k < 16; ++k) stub->transform[k] = upright[k];
  EXPECT_TRUE(push_until(*pen, [&] { return glm::length(pen->newest().pose.axis - Vec3(0, 0, 1)) < 1e-9; }));
  pen->reset();  // an axis does not jump
  EXPECT_TRUE(push_until(*pen, [&] { return stub->force[2] < -0.95 && stub->force[1] > 0.45; }, {{0, 1, 0.5}, {}}));
  EXPECT_EQ(pen->push({{0, 0, 1}, {0, 0, 9}}).reason, NotPushed::NoMotors) << "no motors for torque";
  EXPECT_TRUE(pen->stop());
  EXPECT_EQ(stub->force[1], 0);
  EXPECT_FALSE(stub->output || stub->open || stub->runs);
  EXPECT_EQ(stub->outside, 0) << "values are read and set within frames";
}

TEST_F(Touch, DeclaresTheValuesOfTheLibrary) {
  const auto pen = open_pen("touch");
  const DeviceCapability& arm = pen->capability();
  EXPECT_EQ(arm.name, "Touch");
  EXPECT_NE(capability_text(arm).find("senses x y z a b c, pushes x y z; the hand"), std::string::npos);
  EXPECT_EQ(arm[Coordinate::Y].low, -35);
  EXPECT_EQ(arm[Coordinate::Z].high, 120);
  EXPECT_EQ(arm[Coordinate::X].peak, 3.3);
  EXPECT_EQ(arm[Coordinate::X].continuous, 0.88);
  ASSERT_TRUE(push_until(*pen, [&] { return stub->force[1] > 3.29; }, {{0, 0, 19}, {}}));
  for (int k = 0; k < 100; ++k) {
    pen->push({{0, 0, 19}, {}});
    EXPECT_LE(stub->force[1], 3.3 + 1e-9);
    std::this_thread::sleep_for(1ms);
  }
}

TEST_F(Touch, MissingValuesAreThoseOfTheWeakestArm) {
  stub->max_force = 0, stub->continuous = NAN;
  EXPECT_EQ(open_pen("touch")->capability()[Coordinate::X].peak, 3);
}

TEST_F(Touch, TheNameOfAnArmIsPassedOn) {
  open_pen("touch:Left Device");
  EXPECT_STREQ(state_->arms[1].name, "Left Device");
  open_pen("touch");
  EXPECT_STREQ(stub->name, "");
}

/// The library's thread lets a command go after 20 ms, even if the driver stands still.
TEST_F(Touch, AHostThatHangsPushesNoMore) {
  const auto pen = open_pen("touch");
  ASSERT_TRUE(pushes(*pen));
  class Stuck final : public PenStep {
   public:
    haptics::SafeWrench step(const PenSample&, double, double) noexcept override {
      std::this_thread::sleep_for(300ms);
      return {};
    }
  };
  std::thread late([&] { pen->set_step(std::make_shared<Stuck>()); });
  EXPECT_TRUE(push_until(*pen, [&] { return stub->force[1] == 0; }));
  late.join();
}

TEST_F(Touch, AThreadOfTheLibraryThatHangsEndsTheConnection) {
  const auto pen = open_pen("touch");
  ASSERT_TRUE(pushes(*pen));
  stub->stalled = true;
  EXPECT_TRUE(push_until(*pen, [&] { return pen->status().wrench == Wrench{}; }));
  EXPECT_TRUE(push_until(*pen, [&] { return pen->status().counts.silences == 1; }));
  EXPECT_TRUE(push_until(*pen, [&] { return stub->force[1] == 0; }));
  stub->stalled = false;
  ASSERT_TRUE(push_until(*pen, [&] { return stub->force[1] > 0; }));
  EXPECT_LT(stub->force[1], 0.5) << "from zero";
  EXPECT_TRUE(pushes(*pen));
}

TEST_F(Touch, AnArmThatIsPulledOutIsOpenedAgain) {
  const auto pen = open_pen("touch");
  ASSERT_TRUE(pushes(*pen));
  stub->plugged = false;
  EXPECT_TRUE(push_until(*pen, [&] { return pen->status().state != LinkState::Connected && stub->force[1] == 0; }));
  EXPECT_TRUE(push_until(*pen, [&] { return pen->problem().find("HD_COMM_ERROR") != std::string::npos; }));
  stub->plugged = true;
  EXPECT_TRUE(pushes(*pen));
}

TEST_F(Touch, ErrorsOfForceTripUntilTheyAreReset) {
  const auto pen = open_pen("touch");
  ASSERT_TRUE(pushes(*pen));
  stub->error = 0x0201;  // HD_EXCEEDED_MAX_FORCE
  EXPECT_TRUE(push_until(*pen, [&] { return pen->cause() == haptics::Cause::DeviceFault && stub->force[1] == 0; }));
  EXPECT_EQ(pen->status().state, LinkState::Connected);
  pen->reset();
  EXPECT_TRUE(pushes(*pen));
}

TEST_F(Touch, NoForceBeforeTheCalibrationWhichTheLibraryDoesIfItCan) {
  stub->calibration = 0x5002;  // needs the user
  const auto pen = open_pen("touch");
  EXPECT_TRUE(push_until(*pen, [&] { return answer.reason == NotPushed::NotHomed && stub->frames > 200; }));
  EXPECT_EQ(stub->force[1], 0);
  EXPECT_EQ(stub->updates, 0);
  stub->calibration = 0x5001;  // in the inkwell
  EXPECT_TRUE(pushes(*pen));
  EXPECT_EQ(stub->updates, 1);
}

TEST_F(Touch, AnArmWhoseForceIsSwitchedOffIsResetAndRampsAgain) {
  const auto pen = open_pen("touch");
  ASSERT_TRUE(pushes(*pen));
  stub->output = false;
  EXPECT_TRUE(push_until(*pen, [&] { return answer.reason == NotPushed::NotPowered && stub->force[1] == 0; }));
  stub->output = true;
  EXPECT_TRUE(push_until(*pen, [&] { return pen->newest().homed; }));
  EXPECT_EQ(stub->force[1], 0) << "until it is reset";
  pen->reset();
  ASSERT_TRUE(push_until(*pen, [&] { return stub->force[1] > 0; }));
  EXPECT_LT(stub->force[1], 0.5);
}

TEST_F(Touch, AnArmIsOpenOnceAndTwoAtTheSameTime) {
  const auto pen = open_pen("touch");
  EXPECT_NE(open_problem([] { open_pen("touch"); }).find("busy: Riffler itself has the arm open"), std::string::npos);
  ASSERT_TRUE(pushes(*pen));
  const std::vector<FoundDevice> found = find_touch();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(found[0].is_there);
  EXPECT_EQ(found[0].problem, OpenProblem::Busy);
  const auto other = open_pen("touch:Left Device");
  EXPECT_TRUE(push_until(*other, [&] { return state_->arms[1].force[0] > 0.95; }, {{1, 0, 0}, {}}));
  EXPECT_TRUE(pushes(*pen));
}

TEST_F(Touch, ASearchEnablesNoForceAndNamesMissingLibraries) {
  std::vector<FoundDevice> found = find_touch();
  EXPECT_EQ(found[0].serial, "70001");
  EXPECT_EQ(found[0].problem, OpenProblem::None);
  EXPECT_FALSE(stub->output || stub->open || stub->runs);
  stub->plugged = false;
  EXPECT_EQ(open_problem([] { open_pen("touch"); }), "system error: the library cannot open the arm: HD_COMM_ERROR");
  ::setenv("RIFFLER_LIBHD", "/nowhere/libHD.so", 1);
  found = find_touch();
  EXPECT_FALSE(found[0].is_there);
  EXPECT_EQ(found[0].text,
            "/nowhere/libHD.so: no such file; install 3D Systems' OpenHaptics and Touch driver "
            "(https://support.3dsystems.com) and set RIFFLER_LIBHD to the whole path of its libHD.so");
}

}  // namespace
}  // namespace riffler::pen::hd_devices_test
