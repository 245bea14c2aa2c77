// Force Dimension's arms through a stub of their library: driver, library and arm, with the faults of each.
#include "pen/library/dhd_devices.hpp"

#include <dlfcn.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>

#include "pen/library/library_test.hpp"
#include "pen/library/stub_dhd.hpp"
#include "riffler/pen/registry.hpp"
#include "support/stub_libraries.hpp"

namespace riffler::pen::dhd_devices_test {
namespace {

using namespace std::chrono_literals;
using test::open_problem;
using test::StubArm;
using test::StubDhd;

class ForceDimension : public ::testing::Test {
 protected:
  void SetUp() override {
    ::setenv("RIFFLER_LIBDHD", test::stub_dhd_path(), 1);
    for (int k = 0; k < 2; ++k) arm(k).serial = 1001 + k;
  }
  void TearDown() override { ::unsetenv("RIFFLER_LIBDHD"); }

  StubDhd& stub() { return *state_; }
  StubArm& arm(int number = 0) {
    test::watch(state_->arms[number]);
    return state_->arms[number];
  }
  bool push_until(Pen& pen, const std::function<bool()>& done, const Wrench& wrench = {{0, 0, 1}, {}}) {
    return test::push_until(pen, done, wrench, answer);
  }
  bool pushes(Pen& pen, int number = 0) {
    return push_until(pen, [&] { return arm(number).force[2] > 0.95; });
  }

  const test::StubState<StubDhd> state_;
  PushAnswer answer;
};

/// x towards the user, y right, z up, in m: y right, −x away, z up, in mm.
TEST_F(ForceDimension, ReadsInRifflersAxesAndPushesInTheLibrarys) {
  const auto pen = open_pen("force-dimension");
  EXPECT_EQ(pen->kind(), "force-dimension");
  arm().velocity[0] = 0.1;
  arm().buttons = 5;
  EXPECT_TRUE(push_until(*pen, [&] { return pen->newest().buttons == 5 && pen->newest().homed; }));
  const PenSample sample = pen->newest();
  EXPECT_LT(glm::length(sample.pose.tip - Vec3(20, -10, 30)), 1e-9);
  EXPECT_LT(glm::length(sample.velocity - Vec3(0, -100, 0)), 1e-9);
  EXPECT_LT(glm::length(sample.pose.axis - Vec3(0, -1, 0)), 1e-9) << "its end towards the user";
  EXPECT_TRUE(push_until(*pen, [&] { return arm().force[0] < -0.95; }, {{0, 1, 0.5}, {0, 0, 20}}));
  EXPECT_EQ(answer.reason, NotPushed::None);
  EXPECT_TRUE(
      push_until(*pen, [&] { return std::abs(arm().force[2] - 0.5) < 1e-9 && std::abs(arm().torque[2] - 0.02) < 1e-9; },
                 {{0, 1, 0.5}, {0, 0, 20}}));
  EXPECT_NEAR(arm().force[1], 0, 1e-12);
  EXPECT_TRUE(pen->stop());
  EXPECT_EQ(arm().force[2], 0);
  EXPECT_FALSE(arm().enabled);
  EXPECT_FALSE(arm().open);
}

TEST_F(ForceDimension, DeclaresTheWristThatTheArmHas) {
  EXPECT_EQ(capability_text(open_pen("force-dimension")->capability()), "senses x y z a b c, pushes x y z a b c");
  arm().active = false;
  EXPECT_NE(
      capability_text(open_pen("force-dimension")->capability()).find("senses x y z a b c, pushes x y z; the hand"),
      std::string::npos);
  arm().wrist = false;
  const auto pen = open_pen("force-dimension");
  EXPECT_NE(capability_text(pen->capability()).find("senses x y z, pushes x y z; the hand"), std::string::npos);
  arm().frame[0] = 7;
  EXPECT_TRUE(pushes(*pen)) << "a frame that does not count";
}

TEST_F(ForceDimension, TheArmsOwnWatchdogIsSetAndEndsTheForceOfAHostThatDies) {
  const auto pen = open_pen("force-dimension");
  EXPECT_EQ(arm().watchdog, 160);  // 20 ms
  ASSERT_TRUE(pushes(*pen));
  EXPECT_TRUE(pen->stop());
}

TEST_F(ForceDimension, ReadsAThousandTimesASecondAtMost) {
  const auto pen = open_pen("force-dimension");
  std::this_thread::sleep_for(20ms);
  const std::uint64_t before = pen->newest().sequence;
  const auto start = std::chrono::steady_clock::now();
  std::this_thread::sleep_for(300ms);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const auto reports = static_cast<double>(pen->newest().sequence - before);
  EXPECT_LT(reports, 1000 * seconds + 10);
  EXPECT_GT(reports, 200 * seconds);
  EXPECT_EQ(pen->status().counts.malformed, 0U);
}

TEST_F(ForceDimension, TheForceEndsWithTheRequestsAndNeverExceedsTheLimits) {
  const auto pen = open_pen("force-dimension");
  ASSERT_TRUE(push_until(*pen, [&] { return arm().force[2] > 7.99; }, {{0, 0, 19}, {0, 0, 1100}}));
  for (int k = 0; k < 100; ++k) {
    pen->push({{0, 0, 19}, {0, 0, 1100}});
    EXPECT_LE(arm().force[2], 8 + 1e-9);
    EXPECT_LE(arm().torque[2], 0.15 + 1e-9);
    std::this_thread::sleep_for(1ms);
  }
  std::this_thread::sleep_for(100ms);
  EXPECT_EQ(arm().force[2], 0);
}

TEST_F(ForceDimension, AnArmThatIsPulledOutIsFoundAgainByItsNumberAndTheForceRamps) {
  stub().count = 2;
  const auto pen = open_pen("force-dimension:1002");
  ASSERT_TRUE(pushes(*pen, 1));
  EXPECT_EQ(arm(0).commands, 0) << "the other arm";
  arm(1).plugged = false;
  EXPECT_TRUE(push_until(*pen, [&] { return pen->status().state != LinkState::Connected; }));
  EXPECT_EQ(pen->status().wrench, Wrench{});
  EXPECT_TRUE(push_until(*pen, [&] { return !pen->problem().empty(); }));
  // It comes back under the other number.
  arm(0).serial = 1002, arm(1).serial = 1001, arm(1).plugged = true;
  ASSERT_TRUE(push_until(*pen, [&] { return arm(0).force[2] > 0; }));
  EXPECT_LT(arm(0).force[2], 0.5) << "from zero";
  EXPECT_TRUE(pushes(*pen, 0));
}

TEST_F(ForceDimension, NoForceWithoutPowerCalibrationOrItsButtonAndThenTheRamp) {
  const auto pen = open_pen("force-dimension");
  for (std::atomic<bool>* const fault : {&arm().reset, &arm().button_off}) {
    ASSERT_TRUE(pushes(*pen));
    *fault = true;
    EXPECT_TRUE(push_until(*pen, [&] { return answer.reason != NotPushed::None && arm().force[2] == 0; }));
    EXPECT_TRUE(answer.reason == NotPushed::NotHomed || answer.reason == NotPushed::NotPowered);
    *fault = false;
    EXPECT_TRUE(push_until(*pen, [&] { return pen->newest().homed; }));
    EXPECT_EQ(arm().force[2], 0) << "until it is reset";
    pen->reset();
    ASSERT_TRUE(push_until(*pen, [&] { return arm().force[2] > 0; }));
    EXPECT_LT(arm().force[2], 0.5);
  }
  ASSERT_TRUE(pushes(*pen));
  arm().error = true;
  EXPECT_TRUE(push_until(*pen, [&] { return pen->cause() == haptics::Cause::DeviceFault; }));
  EXPECT_TRUE(push_until(*pen, [&] { return arm().force[2] == 0; }));
  arm().error = false;
  EXPECT_TRUE(push_until(*pen, [&] { return pen->newest().fault == 0; }));
  EXPECT_EQ(arm().force[2], 0) << "until it is reset";
  pen->reset();
  EXPECT_TRUE(pushes(*pen));
}

TEST_F(ForceDimension, AJumpTripsAndImpossibleReadingsAreNoSignOfLife) {
  const auto pen = open_pen("force-dimension");
  ASSERT_TRUE(pushes(*pen));
  arm().position[0] = 0.2;
  EXPECT_TRUE(push_until(*pen, [&] { return pen->cause() == haptics::Cause::Jump && arm().force[2] == 0; }));
  pen->reset();
  ASSERT_TRUE(pushes(*pen));
  arm().position[1] = NAN;
  EXPECT_TRUE(push_until(*pen, [&] { return pen->status().counts.silences == 1; }));
  EXPECT_EQ(arm().force[2], 0);
  arm().position[1] = 0;
  pen->reset();
  ASSERT_TRUE(pushes(*pen));
  arm().frame[0] = -1;  // a mirror
  EXPECT_TRUE(push_until(*pen, [&] { return pen->status().counts.silences == 2; }));
}

TEST_F(ForceDimension, ASearchListsTheArmsAndEnablesNoForce) {
  stub().count = 2;
  const std::vector<FoundDevice> found = find_force_dimension();
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].path, "force-dimension:1001");
  EXPECT_EQ(found[1].serial, "1002");
  EXPECT_EQ(found[0].name, "sigma.7");
  EXPECT_NE(found[0].about.find("a wrist with motors"), std::string::npos);
  EXPECT_EQ(arm().commands, 0);
  EXPECT_FALSE(arm().open);
  const auto pen = open_pen("force-dimension:1001");
  const std::vector<FoundDevice> again = find_force_dimension();
  EXPECT_EQ(again[0].problem, OpenProblem::Busy) << again[0].text;
  EXPECT_EQ(again[1].problem, OpenProblem::None);
  EXPECT_TRUE(pushes(*pen)) << "the search has not closed it";
}

TEST_F(ForceDimension, AnArmThatDoesNotOpenReportsTheReason) {
  EXPECT_EQ(open_problem([] { open_pen("force-dimension:7"); }),
            "not there: no arm with the serial number 7 is plugged in");
  arm().plugged = false;
  EXPECT_EQ(open_problem([] { open_pen("force-dimension"); }),
            "system error: the library cannot open the arm: communication error");
  stub().count = 0;
  EXPECT_EQ(open_problem([] { open_pen("force-dimension"); }), "not there: no arm is plugged in and switched on");
  ASSERT_EQ(find_force_dimension().size(), 1U);
  EXPECT_FALSE(find_force_dimension()[0].is_there);
}

TEST_F(ForceDimension, TheErrorOfAMissingOrWrongLibraryNamesTheFileToInstall) {
  const auto text = [](const char* path) {
    ::setenv("RIFFLER_LIBDHD", path, 1);
    return open_problem([] { open_pen("force-dimension"); });
  };
  EXPECT_EQ(text("/nowhere/libdhd.so"),
            "not installed: /nowhere/libdhd.so: no such file; install Force Dimension's SDK "
            "(https://www.forcedimension.com/software/sdk) and set RIFFLER_LIBDHD to the whole path of its libdhd.so");
  EXPECT_NE(text("libdhd.so").find("not installed: libdhd.so: give the library's whole path"), std::string::npos);
  EXPECT_NE(text("/etc/passwd").find("wrong library: /etc/passwd: the system cannot load it"), std::string::npos);
  ::Dl_info libc{};
  ASSERT_NE(::dladdr(reinterpret_cast<void*>(&::getpid), &libc), 0);
  EXPECT_NE(text(libc.dli_fname).find("it has no function dhdGetDeviceCount; is it of another version?"),
            std::string::npos);
  ::unsetenv("RIFFLER_LIBDHD");
  const std::vector<FoundDevice> found = find_unavailable();
  bool listed = false;
  for (const FoundDevice& one : found) listed |= one.path == "force-dimension" && !one.text.empty();
  EXPECT_TRUE(listed);
}

/// A library that lies where the system has its own is named, and not loaded by a search.
TEST_F(ForceDimension, ALibraryThatItsUserHasNotChosenIsNotLoaded) {
  ::unsetenv("RIFFLER_LIBDHD");
  std::string folder = ::testing::TempDir() + "riffler_libdhd_XXXXXX";
  ASSERT_NE(::mkdtemp(folder.data()), nullptr);
  std::filesystem::copy_file(test::stub_dhd_path(), folder + "/libdhd.so.3");
  const char* const before = std::getenv("LD_LIBRARY_PATH");
  const std::string kept = before == nullptr ? "" : before;
  ::setenv("LD_LIBRARY_PATH", folder.c_str(), 1);
  const std::vector<FoundDevice> found = find_force_dimension();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_FALSE(found[0].is_there);
  EXPECT_EQ(found[0].problem, OpenProblem::NotChosen);
  EXPECT_NE(found[0].text.find(folder + "/libdhd.so.3 is there; open the arm as \"force-dimension\""),
            std::string::npos);
  EXPECT_EQ(arm().opened, 0) << "it was not loaded";
  EXPECT_EQ(open_pen("force-dimension")->kind(), "force-dimension");
  ::setenv("LD_LIBRARY_PATH", kept.c_str(), 1);
}

}  // namespace
}  // namespace riffler::pen::dhd_devices_test
