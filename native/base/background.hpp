// A long call on a thread of its own.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>

#include "base/own_thread.hpp"
#include "riffler/base/progress.hpp"

namespace riffler::base {

/// Runs `work` at once, on a new thread. Any thread may ask about it; cancelling works wherever `work` reports, and
/// what `work` holds is destroyed on that thread as soon as it has ended. In a process that was forked meanwhile the
/// work counts as done, and lost.
class Background {
 public:
  using Work = std::function<void(const Progress&)>;

  explicit Background(Work work);
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;
  /// Cancels and waits.
  ~Background();

  /// Of the work, in [0, 1]; never goes back, and is 1 only where the work came to its end.
  double share() const { return share_.load(std::memory_order_relaxed); }
  /// Whether the work has ended, by itself, by an error or cancelled. What it wrote is then visible to who asks.
  bool done() const { return done_.load(std::memory_order_acquire) || !home_.here(); }
  /// Asks the work to end with Cancelled; without effect where it has ended. Does not wait.
  void cancel() { cancelled_.store(true, std::memory_order_relaxed); }
  /// Waits until the work has ended, at most for `most`; whether it has.
  bool wait(std::chrono::milliseconds most) const;
  void wait() const;
  /// Throws what the work threw. Only where it is done.
  void check() const;

 private:
  void run(Work work);

  std::atomic<double> share_{0};
  std::atomic<bool> cancelled_{false}, done_{false};
  mutable std::mutex mutex_;
  HomeOnly<std::condition_variable> ended_;
  HomeProcess home_;
  std::exception_ptr error_;
  OwnThread thread_;  // the last: it uses all others
};

}  // namespace riffler::base
