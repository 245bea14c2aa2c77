// Makes a real-time thread normal again that runs on and on, before it takes the machine from everything else.
//
// The system counts how long such a thread runs without waiting (RLIMIT_RTTIME) and sends SIGXCPU, to the thread itself
// unless that blocks it. The handler here then makes the thread normal: nothing is lost but its priority.
#pragma once

#include <sys/types.h>

#include <atomic>
#include <cstdint>
#include <optional>

namespace riffler::base {

/// Guards the thread that creates it, as long as it exists; that thread must destroy it.
class OverrunGuard {
 public:
  /// `overran` becomes true when the thread was made normal, and must outlive this object. `seconds`: that it may run
  /// without waiting; 0.01 at least.
  OverrunGuard(std::atomic<bool>& overran, double seconds);
  ~OverrunGuard();
  OverrunGuard(const OverrunGuard&) = delete;
  OverrunGuard& operator=(const OverrunGuard&) = delete;

  /// False if the thread is not guarded: too many are already, or the system refuses the limit.
  bool guards() const { return slot_.has_value(); }
  /// Lowers the hard limit of the whole process, at which the system ends it; it cannot be raised again. rtkit asks
  /// for that. False if the system refuses it.
  static bool lower_hard_limit(std::int64_t microseconds);

 private:
  std::optional<int> slot_;
};

/// Makes a thread SCHED_RR with that level, or normal for 0; threads and processes that it starts are normal in both
/// cases. `thread`: 0 for the calling one. Returns 0 or an errno. Async-signal-safe.
int schedule_thread(pid_t thread, int level) noexcept;
/// Whether the system runs a thread as a real-time one.
bool is_real_time(pid_t thread) noexcept;
/// The system's number of the calling thread.
pid_t thread_number() noexcept;

}  // namespace riffler::base
