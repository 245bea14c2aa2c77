// Real-time priority as the system grants or refuses it, and as rtkit does, which is played by a fake.
#include "base/real_time.hpp"

#include <gtest/gtest.h>
#include <linux/capability.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <functional>

#include "base/own_thread.hpp"
#include "base/posix/overrun_guard.hpp"
#include "base/posix/system_bus.hpp"
#include "support/fake_rtkit.hpp"

namespace riffler::base::real_time_test {
namespace {

using Does = test::FakeRtkit::Does;
using namespace std::chrono_literals;

constexpr const char* kNoBus = "unix:path=/nowhere/at/all";

bool system_grants() {
  return probe_real_time({.answer = 0.1, .bus = kNoBus}).real_time();
}

/// Takes the right to real-time priority from the calling thread. False if that is not possible.
bool give_up_rights() {
  struct __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  struct __user_cap_data_struct data[2]{};
  if (syscall(SYS_capget, &header, data) != 0) return false;
  data[0].effective &= ~(1U << CAP_SYS_NICE), data[0].permitted &= ~(1U << CAP_SYS_NICE);
  return syscall(SYS_capset, &header, data) == 0;
}

/// What a thread without the right to it is granted, and how the system runs it then.
struct Granted {
  ThreadPriority priority;
  bool runs_so = false;
  double seconds = 0;  // that the creation took
};

/// RLIMIT_RTPRIO 0 while it exists.
struct NoLevels {
  NoLevels() {
    getrlimit(RLIMIT_RTPRIO, &before);
    const rlimit none{0, before.rlim_max};
    setrlimit(RLIMIT_RTPRIO, &none);
  }
  ~NoLevels() { setrlimit(RLIMIT_RTPRIO, &before); }
  rlimit before{};
};

Granted asked_without_rights(const RealTimeSettings& settings) {
  const NoLevels none;
  Granted out;
  PriorityReport report;
  std::thread([&] {
    ASSERT_TRUE(give_up_rights());
    const auto start = std::chrono::steady_clock::now();
    RealTimeScope scope(report, settings);
    out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    scope.wait();
    out.priority = report.get(), out.runs_so = is_real_time(0);
  }).join();
  return out;
}

/// In a process of its own, whose limits may change: 0 if it returns true.
int in_a_child(const std::function<bool()>& what) {
  const pid_t child = fork();
  if (child == 0) _exit(what() ? 0 : 1);
  int status = -1;
  waitpid(child, &status, 0);
  return status;
}

/// Computes for so long without waiting for anything.
void run_on(double seconds) {
  for (const double end = thread_seconds() + seconds; thread_seconds() < end;) {
  }
}

TEST(RealTime, IsGrantedToRootWithItsGuardAndEndsWithTheScope) {
  if (!system_grants()) GTEST_SKIP() << "this user may not have real-time priority: " << probe_real_time().text;
  PriorityReport report;
  EXPECT_FALSE(report.get().real_time());
  rlimit before{}, during{}, after{};
  getrlimit(RLIMIT_RTTIME, &before);
  bool ended = false;
  std::thread([&] {
    {
      const RealTimeScope scope(report, {.bus = kNoBus});
      EXPECT_EQ(sched_getscheduler(0), SCHED_RR | SCHED_RESET_ON_FORK);
      sched_param parameters{};
      sched_getparam(0, &parameters);
      EXPECT_EQ(parameters.sched_priority, 20);
      getrlimit(RLIMIT_RTTIME, &during);
      std::thread([] { EXPECT_FALSE(is_real_time(0)) << "a thread of the thread"; }).join();
    }
    ended = !is_real_time(0);
  }).join();
  getrlimit(RLIMIT_RTTIME, &after);
  EXPECT_TRUE(ended);
  EXPECT_EQ(report.get().level, 20);
  EXPECT_EQ(report.get().by, ThreadPriority::By::System);
  EXPECT_EQ(report.get().text, "real time, level 20, granted by the system");
  EXPECT_EQ(during.rlim_cur, 100'000U);
  EXPECT_EQ(after.rlim_cur, before.rlim_cur);
  EXPECT_EQ(after.rlim_max, before.rlim_max);
}

TEST(RealTime, AThreadThatNeverWaitsBecomesNormalAndOthersRun) {
  if (!system_grants()) GTEST_SKIP() << "this user may not have real-time priority";
  PriorityReport report;
  double took = 0;
  std::thread([&] {
    const RealTimeScope scope(report, {.guard = 0.05, .bus = kNoBus});
    ASSERT_TRUE(is_real_time(0));
    // Short pieces with pauses are what such a thread is for.
    for (int k = 0; k < 20; ++k) run_on(0.01), std::this_thread::sleep_for(1ms);
    EXPECT_TRUE(is_real_time(0));
    const double start = thread_seconds();
    while (is_real_time(0) && thread_seconds() < start + 2) {
    }
    took = thread_seconds() - start;
    run_on(0.2);  // a normal thread may
  }).join();
  EXPECT_LT(took, 0.3);
  EXPECT_FALSE(report.get().real_time());
  EXPECT_NE(report.get().text.find("guard"), std::string::npos) << report.get().text;
  // The next thread has the same guard: the system's raised limit was taken back.
  took = 0;
  PriorityReport next;
  std::thread([&] {
    const RealTimeScope scope(next, {.guard = 0.05, .bus = kNoBus});
    const double start = thread_seconds();
    while (is_real_time(0) && thread_seconds() < start + 2) {
    }
    took = thread_seconds() - start;
  }).join();
  EXPECT_LT(took, 0.3);
}

TEST(RealTime, TwoThreadsAreGuardedEachForItself) {
  if (!system_grants()) GTEST_SKIP() << "this user may not have real-time priority";
  PriorityReport runs, waits;
  std::atomic<bool> ended{false};
  std::thread waiting([&] {
    const RealTimeScope scope(waits, {.bus = kNoBus});
    while (!ended) std::this_thread::sleep_for(1ms);
    EXPECT_TRUE(is_real_time(0));
  });
  std::thread([&] {
    const RealTimeScope scope(runs, {.guard = 0.05, .bus = kNoBus});
    run_on(0.4);
    EXPECT_FALSE(is_real_time(0));
  }).join();
  ended = true;
  waiting.join();
  EXPECT_FALSE(runs.get().real_time());
  EXPECT_TRUE(waits.get().real_time());
}

TEST(RealTime, ARefusalNamesTheReasonAndTheRemedy) {
  // A process of its own, as a user would have it: neither the right nor a limit above 0.
  EXPECT_EQ(in_a_child([] {
              const rlimit none{0, 0};
              setrlimit(RLIMIT_RTPRIO, &none);
              if (!give_up_rights()) return false;
              const ThreadPriority got = probe_real_time({.answer = 0.2, .bus = kNoBus});
              return !got.real_time() && got.by == ThreadPriority::By::Nobody &&
                     got.text.starts_with("normal: the system refuses real time; there is no message bus at unix:") &&
                     got.remedy.find("limits.d") != std::string::npos && got.remedy.find("rtkit") != std::string::npos;
            }),
            0);
}

bool limit_levels(rlim_t most) {
  const rlimit limit{most, most};
  return setrlimit(RLIMIT_RTPRIO, &limit) == 0;
}

TEST(RealTime, ALimitBelowTheUsualLevelIsUsed) {
  if (in_a_child([] { return limit_levels(5); }) != 0)
    GTEST_SKIP() << "this user may not raise RLIMIT_RTPRIO (CAP_SYS_RESOURCE)";
  EXPECT_EQ(
      in_a_child([] { return limit_levels(5) && give_up_rights() && probe_real_time({.bus = kNoBus}).level == 5; }), 0);
}

TEST(RealTime, IsNotRequestedIfTheUserSwitchesItOff) {
  EXPECT_EQ(in_a_child([] {
              setenv("RIFFLER_REAL_TIME", "0", 1);
              const ThreadPriority got = probe_real_time();
              return !got.real_time() && got.text == "normal: RIFFLER_REAL_TIME is 0" && got.remedy.empty();
            }),
            0);
}

TEST(RealTime, RtkitGrantsWhatTheSystemRefuses) {
  if (!system_grants()) GTEST_SKIP() << "the fake rtkit may not have real-time priority itself";
  // The hard limit that rtkit asks for stays with its process.
  EXPECT_EQ(in_a_child([] {
              const test::FakeRtkit rtkit(Does::Grants, 15);
              const Granted got = asked_without_rights({.bus = rtkit.address()});
              rlimit limit{};
              getrlimit(RLIMIT_RTTIME, &limit);
              return got.priority.level == 15 && got.priority.by == ThreadPriority::By::Rtkit && got.runs_so &&
                     rtkit.asked() == 1 && rtkit.level() == 15 && limit.rlim_max == 200'000 &&
                     got.priority.text == "real time, level 15, granted by rtkit";
            }),
            0);
}

TEST(RealTime, AnyFaultOfRtkitIsReportedAndTheThreadContinues) {
  if (!system_grants()) GTEST_SKIP() << "this user may not have real-time priority: nothing can be refused";
  const std::pair<Does, const char*> cases[] = {
      {Does::Refuses, "rtkit refuses it (org.freedesktop.DBus.Error.AccessDenied)"},
      {Does::IsNotInstalled, "rtkit is not installed"},
      {Does::OnlyAgrees, "rtkit agreed, but the thread has no real-time priority"},
      {Does::SaysNonsense, "the message bus answers nonsense"},
      {Does::NamesNoNumber, "rtkit answers nonsense"},
      {Does::NamesHugeLevel, "rtkit answers nonsense"},
      {Does::IsSilent, "the message bus does not answer"},
      {Does::NeverLogsIn, "the message bus does not answer"},
      {Does::RejectsLogIn, "the message bus refuses this user"},
      {Does::HangsUp, "the message bus has closed the connection"},
  };
  for (const auto& [does, why] : cases)
    EXPECT_EQ(in_a_child([does = does, why = std::string(why)] {
                const test::FakeRtkit rtkit(does);
                const Granted got = asked_without_rights({.answer = 0.3, .bus = rtkit.address()});
                const bool right = !got.priority.real_time() && !got.runs_so && got.seconds < 0.1 &&
                                   got.priority.text == "normal: the system refuses real time; " + why;
                if (!right) std::fprintf(stderr, "%s\n", got.priority.text.c_str());
                return right;
              }),
              0)
        << why;
}

TEST(RealTime, AThreadThatEndsWhileRtkitIsSilentDoesNotWaitForIt) {
  const test::FakeRtkit rtkit(Does::IsSilent);
  const NoLevels none;
  PriorityReport report;
  const auto start = std::chrono::steady_clock::now();
  std::thread([&] {
    ASSERT_TRUE(give_up_rights());
    const RealTimeScope scope(report, {.answer = 30, .bus = rtkit.address()});
  }).join();
  EXPECT_LT(std::chrono::steady_clock::now() - start, 5s);
}

}  // namespace
}  // namespace riffler::base::real_time_test
