// The program riffler-arm through a stub of libdhd: its end, its crash, its silence, the end of Riffler, and how long a
// command takes to reach the arm.
#include "pen/library/arm_process.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <thread>
#include <vector>

#include "pen/library/library_test.hpp"
#include "pen/library/stub_dhd.hpp"
#include "riffler/pen/registry.hpp"

namespace riffler::pen::arm_process_test {
namespace {

using namespace std::chrono_literals;
using test::open_problem;
using test::StubArm;
using test::StubDhd;

std::vector<std::uint8_t> up(double newtons) {
  const ArmCommand command{{0, 0, newtons}, {0, 0, 0}};
  std::vector<std::uint8_t> bytes(sizeof command);
  std::memcpy(bytes.data(), &command, sizeof command);
  return bytes;
}

bool soon(const std::function<bool()>& done) {
  const auto end = std::chrono::steady_clock::now() + 10s;
  while (!done() && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(1ms);
  return done();
}

class ArmProgram : public ::testing::Test {
 protected:
  void SetUp() override { arm().watchdog = 0; }
  StubArm& arm() { return state_->arms[0]; }
  /// Until the arm pushes so much, with new commands.
  bool pushes(ArmProcess& process, double newtons) {
    return soon([&] { return process.write(up(newtons)) && arm().force[2] == newtons; });
  }

  const test::StubState<StubDhd> state_;
  const ArmLibrary library{"dhd", test::stub_dhd_path(), "install it"};
};

TEST_F(ArmProgram, ReadsAndPushesAndEndsWithItsOwner) {
  pid_t program = 0;
  {
    ArmProcess process(library, "");
    program = process.process();
    std::vector<std::uint8_t> bytes(sizeof(ArmState));
    EXPECT_EQ(process.read(std::span(bytes).first(8), 0), -1) << "no room for a reading";
    for (int k = 0; k < 20; ++k) ASSERT_EQ(process.read(bytes, 5), static_cast<int>(sizeof(ArmState)));
    ArmState state;
    std::memcpy(&state, bytes.data(), sizeof state);
    EXPECT_LT(glm::length(state.position - Vec3(20, -10, 30)), 1e-9);
    EXPECT_TRUE(pushes(process, 2));
    EXPECT_FALSE(process.write({})) << "no command";
  }
  EXPECT_EQ(arm().force[2], 0);
  EXPECT_FALSE(arm().open);
  EXPECT_NE(::kill(program, 0), 0);
}

TEST_F(ArmProgram, ACommandHoldsTwentyMillisecondsWithoutAnyWatchdogOfTheArm) {
  ArmProcess process(library, "");
  arm().watchdog = 0;  // an old library has none
  ASSERT_TRUE(pushes(process, 3));
  EXPECT_TRUE(soon([&] { return arm().force[2] == 0; }));
  EXPECT_TRUE(arm().open);
  ASSERT_TRUE(pushes(process, 3)) << "and again";
}

TEST_F(ArmProgram, TheForceEndsAndTheArmIsClosedWhenRifflerIsKilled) {
  const pid_t owner = ::fork();
  if (owner == 0) {
    ArmProcess process(library, "");
    arm().watchdog = 0;
    for (;;) {
      process.write(up(4));
      std::this_thread::sleep_for(1ms);
    }
  }
  ASSERT_TRUE(soon([&] { return arm().force[2] == 4; }));
  ::kill(owner, SIGKILL);
  ::waitpid(owner, nullptr, 0);
  EXPECT_TRUE(soon([&] { return arm().force[2] == 0; }));
  EXPECT_TRUE(soon([&] { return !arm().open; }));
}

TEST_F(ArmProgram, ALibraryThatCrashesDisconnectsOneArm) {
  {
    ArmProcess process(library, "");
    ASSERT_TRUE(pushes(process, 1));
    arm().crashes = true;
    std::vector<std::uint8_t> bytes(sizeof(ArmState));
    EXPECT_TRUE(soon([&] { return process.read(bytes, 0.1) == -1; }));
  }
  // The system closes what the program had open.
  arm().open = false;
  ::setenv("RIFFLER_LIBDHD", test::stub_dhd_path(), 1);
  const auto pen = open_pen("force-dimension");
  PushAnswer answer;
  const auto lifts = [&] {
    return test::push_until(*pen, [&] { return arm().force[2] > 0.9; }, {{0, 0, 1}, {}}, answer);
  };
  ASSERT_TRUE(lifts());
  arm().open = false;
  arm().crashes = true;
  EXPECT_TRUE(soon([&] { return arm().opened == 3; })) << "the driver opens it again";
  EXPECT_TRUE(lifts());
  ::unsetenv("RIFFLER_LIBDHD");
}

TEST_F(ArmProgram, ALibraryThatCrashesOrHangsWhileItOpensIsNamed) {
  arm().crashes = true;
  EXPECT_NE(open_problem([&] {
              ArmProcess(library, "");
            }).find("the program that loads it has not opened an arm: it crashed (Aborted"),
            std::string::npos);
  arm().open = false;
  arm().hangs = true;
  ArmLibrary impatient = library;
  impatient.patience = 0.2;
  EXPECT_NE(open_problem([&] { ArmProcess(impatient, ""); }).find("no answer: "), std::string::npos);
  arm().hangs = arm().open = false;
  EXPECT_EQ(list_arms(library).size(), 1U);
}

/// Until the driver closes it, an arm whose library hangs gives no readings; closing it does not wait for the library.
TEST_F(ArmProgram, ALibraryThatHangsIsKilled) {
  auto process = std::make_unique<ArmProcess>(library, "");
  ASSERT_TRUE(pushes(*process, 1));
  const pid_t program = process->process();
  arm().hangs = true;
  std::vector<std::uint8_t> bytes(sizeof(ArmState));
  EXPECT_TRUE(soon([&] { return process->read(bytes, 0.05) == 0; }));
  process.reset();
  EXPECT_NE(::kill(program, 0), 0);
  arm().hangs = false;
}

TEST_F(ArmProgram, NeedsNoPermissionToExecute) {
  const std::string copy = ::testing::TempDir() + "riffler-arm-copy";
  std::filesystem::copy_file(test::arm_program_path(), copy, std::filesystem::copy_options::overwrite_existing);
  std::filesystem::permissions(copy, std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  ::setenv("RIFFLER_ARM_PROGRAM", copy.c_str(), 1);
  ArmProcess process(library, "");
  EXPECT_TRUE(pushes(process, 1));
  std::filesystem::remove(copy);
}

TEST_F(ArmProgram, AMissingOrBrokenProgramIsNamedWithTheRemedy) {
  ::setenv("RIFFLER_ARM_PROGRAM", "/nowhere/riffler-arm", 1);
  EXPECT_EQ(
      open_problem([&] { ArmProcess(library, ""); }),
      "system error: cannot start the program that loads the arm's library: /nowhere/riffler-arm: No such file or "
      "directory; install Riffler again, or set RIFFLER_ARM_PROGRAM to the whole path of riffler-arm");
  ::setenv("RIFFLER_ARM_PROGRAM", "/bin/true", 1);
  EXPECT_NE(open_problem([&] { ArmProcess(library, ""); }).find("it ended with code 0"), std::string::npos);
}

/// Not judged: what a turn takes depends on what else the machine does.
TEST_F(ArmProgram, EveryCommandArrives) {
  ArmProcess process(library, "");
  ASSERT_TRUE(pushes(process, 0.5));
  std::vector<double> turns;
  for (int k = 1; k <= 300; ++k) {
    const double newtons = 1 + 1e-3 * k;
    const auto begin = std::chrono::steady_clock::now();
    ASSERT_TRUE(process.write(up(newtons)));
    while (arm().force[2] != newtons && std::chrono::steady_clock::now() - begin < 10s) {
    }
    ASSERT_EQ(arm().force[2], newtons);
    turns.push_back(1e6 * std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    std::this_thread::sleep_for(200us);
  }
  std::sort(turns.begin(), turns.end());
  std::printf("command to arm: median %.0f us, 99 %% %.0f us\n", turns[turns.size() / 2], turns[297]);
}

}  // namespace
}  // namespace riffler::pen::arm_process_test
