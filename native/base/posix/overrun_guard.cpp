#include "base/posix/overrun_guard.hpp"

#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <mutex>

#ifndef SCHED_RESET_ON_FORK
#define SCHED_RESET_ON_FORK 0x40000000  // linux/sched.h
#endif

namespace riffler::base {

namespace {

constexpr int kSlots = 32;  // guarded threads at a time
constexpr double kShortest = 0.01;

/// The handler reads these while threads come and go.
struct Slot {
  std::atomic<pid_t> thread{0};  // 0: free
  std::atomic<std::atomic<bool>*> overran{nullptr};
};
struct Guards {
  std::array<Slot, kSlots> slots;
  std::atomic<rlim_t> soft_limit{RLIM_INFINITY};  // µs, while any thread is guarded
  struct sigaction others{};                      // what was done with the signal before

  std::mutex mutex;  // of what follows
  int count = 0;
  rlimit before{RLIM_INFINITY, RLIM_INFINITY};
  bool installed = false;
} shared;

/// The system raises the soft limit by a second with each signal: the next thread must not have that second.
bool set_soft_limit(rlim_t microseconds) noexcept {
  rlimit now{};
  if (getrlimit(RLIMIT_RTTIME, &now) != 0) return false;
  now.rlim_cur = std::min(microseconds, now.rlim_max);
  return setrlimit(RLIMIT_RTTIME, &now) == 0;
}

/// A signal that is not for a guarded thread: the process has used up its processor time (RLIMIT_CPU), or a real-time
/// thread of another library runs into the limit that is set here.
void pass_on(int signal, siginfo_t* info, void* context) noexcept {
  if ((shared.others.sa_flags & SA_SIGINFO) != 0) return shared.others.sa_sigaction(signal, info, context);
  if (shared.others.sa_handler == SIG_IGN) return;
  if (shared.others.sa_handler != SIG_DFL) return shared.others.sa_handler(signal);
  rlimit all{RLIM_INFINITY, RLIM_INFINITY};
  getrlimit(RLIMIT_CPU, &all);
  if (all.rlim_cur == RLIM_INFINITY) return;
  struct sigaction usual{};
  usual.sa_handler = SIG_DFL;
  sigaction(signal, &usual, nullptr);
  raise(signal);
}

/// Async-signal-safe: system calls and atomics only.
void on_overrun(int signal, siginfo_t* info, void* context) {
  const int error = errno;
  const pid_t here = thread_number();
  bool mine = false;
  for (Slot& slot : shared.slots)
    if (slot.thread.load() == here) {
      mine = true;
      schedule_thread(0, 0);
      if (std::atomic<bool>* const overran = slot.overran.load()) overran->store(true);
    }
  if (mine)
    set_soft_limit(shared.soft_limit.load());
  else
    pass_on(signal, info, context);
  errno = error;
}

/// Installs the handler for good: another library may have put its own over it meanwhile.
bool install() {
  if (shared.installed) return true;
  struct sigaction action{};
  action.sa_sigaction = on_overrun;
  action.sa_flags = SA_SIGINFO | SA_RESTART;
  sigemptyset(&action.sa_mask);
  return shared.installed = sigaction(SIGXCPU, &action, &shared.others) == 0;
}

bool begin_limit(double seconds) {
  if (shared.count == 0) {
    if (getrlimit(RLIMIT_RTTIME, &shared.before) != 0) return false;
    shared.soft_limit = RLIM_INFINITY;
  }
  const auto wanted = static_cast<rlim_t>(1e6 * std::max(seconds, kShortest));
  shared.soft_limit = std::min({shared.soft_limit.load(), wanted, shared.before.rlim_cur});
  return set_soft_limit(shared.soft_limit);
}

}  // namespace

OverrunGuard::OverrunGuard(std::atomic<bool>& overran, double seconds) {
  const std::lock_guard lock(shared.mutex);
  const auto free =
      std::find_if(shared.slots.begin(), shared.slots.end(), [](const Slot& s) { return s.thread.load() == 0; });
  if (free == shared.slots.end() || !install() || !begin_limit(seconds)) return;
  free->overran = &overran;
  free->thread = thread_number();
  ++shared.count;
  slot_ = static_cast<int>(free - shared.slots.begin());
  sigset_t only;
  sigemptyset(&only);
  sigaddset(&only, SIGXCPU);
  pthread_sigmask(SIG_UNBLOCK, &only, nullptr);
}

OverrunGuard::~OverrunGuard() {
  if (!slot_) return;
  Slot& slot = shared.slots[static_cast<std::size_t>(*slot_)];
  slot.thread = 0;
  slot.overran = nullptr;
  const std::lock_guard lock(shared.mutex);
  if (--shared.count == 0) set_soft_limit(shared.before.rlim_cur);
}

bool OverrunGuard::lower_hard_limit(std::int64_t microseconds) {
  const std::lock_guard lock(shared.mutex);
  rlimit now{};
  if (getrlimit(RLIMIT_RTTIME, &now) != 0) return false;
  now.rlim_max = std::min(now.rlim_max, static_cast<rlim_t>(microseconds));
  now.rlim_cur = std::min(now.rlim_cur, now.rlim_max);
  return setrlimit(RLIMIT_RTTIME, &now) == 0;
}

int schedule_thread(pid_t thread, int level) noexcept {
  sched_param parameters{};
  parameters.sched_priority = level;
  const int policy = level > 0 ? SCHED_RR : SCHED_OTHER;
  return sched_setscheduler(thread, policy | SCHED_RESET_ON_FORK, &parameters) == 0 ? 0 : errno;
}

bool is_real_time(pid_t thread) noexcept {
  const int policy = sched_getscheduler(thread) & ~SCHED_RESET_ON_FORK;
  return policy == SCHED_RR || policy == SCHED_FIFO;
}

pid_t thread_number() noexcept {
  return static_cast<pid_t>(syscall(SYS_gettid));
}

}  // namespace riffler::base
