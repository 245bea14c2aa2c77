// Real-time priority for a thread that a hand depends on: asked of the system, then of rtkit.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "riffler/base/thread_priority.hpp"

namespace riffler::base {

/// What a thread was granted, for other threads.
class PriorityReport {
 public:
  PriorityReport() : priority_{0, ThreadPriority::By::Nobody, "normal: real time was not asked for", {}} {}

  /// Never call it from the real-time thread.
  ThreadPriority get() const {
    if (overran_) return overran_priority();
    const std::lock_guard lock(mutex_);
    return priority_;
  }
  void set(ThreadPriority priority) {
    const std::lock_guard lock(mutex_);
    priority_ = std::move(priority);
  }
  /// Set when the guard has made the thread normal.
  std::atomic<bool>& overran() { return overran_; }

 private:
  static ThreadPriority overran_priority() {
    return {0,
            ThreadPriority::By::Nobody,
            "normal: the thread ran too long without a pause, and the guard took its priority away",
            {}};
  }

  mutable std::mutex mutex_;
  ThreadPriority priority_;
  std::atomic<bool> overran_{false};
};

struct RealTimeSettings {
  int level = 20;      ///< below audio and below the system's own threads
  double guard = 0.1;  ///< s that the thread may run without waiting; then it becomes a normal one
  double answer = 1;   ///< s for rtkit to answer
  std::string bus{};   ///< address of the system's bus; empty: the usual one
};

/// Gives the thread that creates it real-time priority (SCHED_RR) if the system grants it, for as long as it exists;
/// that thread must destroy it. What it got is in the report, which must outlive this object. Without a grant nothing
/// changes, nor with RIFFLER_REAL_TIME=0. rtkit is asked by a thread of its own, so this one does not wait.
class RealTimeScope {
 public:
  explicit RealTimeScope(PriorityReport& report, const RealTimeSettings& settings = {});
  ~RealTimeScope();
  RealTimeScope(const RealTimeScope&) = delete;
  RealTimeScope& operator=(const RealTimeScope&) = delete;

  /// Waits until rtkit has answered, or its time is over.
  void wait();

 private:
  class Grant;
  std::unique_ptr<Grant> grant_;
};

/// What the system would grant a thread of this process now. Takes as long as rtkit, 1 s at most.
ThreadPriority probe_real_time(const RealTimeSettings& settings = {});

}  // namespace riffler::base
