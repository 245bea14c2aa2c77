// Runs a long call on its own thread.
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

/// Starts `work` at once on a new thread. Any thread may query it. Cancelling takes effect when `work` next reports its
/// progress. Once the work has ended, that thread destroys everything that `work` holds. In a forked process the work
/// counts as done, and its result is lost.
class Background {
 public:
  using Work = std::function<void(const Progress&)>;

  explicit Background(Work work);
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;
  /// Cancels the work and waits for its end.
  ~Background();

  /// Finished fraction in [0, 1]. Never decreases, and is 1 only if the work ran to its end.
  double share() const { return share_.load(std::memory_order_relaxed); }
  /// Whether the work has ended: completed, failed or cancelled. Once true, everything the work wrote is visible to the
  /// caller.
  bool done() const { return done_.load(std::memory_order_acquire) || !home_.here(); }
  /// Requests that the work end with Cancelled; no effect if it has ended. Does not wait.
  void cancel() { cancelled_.store(true, std::memory_order_relaxed); }
  /// Waits until the work has ended, for at most `most`. Returns whether it has.
  bool wait(std::chrono::milliseconds most) const;
  void wait() const;
  /// Rethrows the exception of the work, if any. Call it only after done().
  void check() const;

 private:
  void run(Work work);

  std::atomic<double> share_{0};
  std::atomic<bool> cancelled_{false}, done_{false};
  mutable std::mutex mutex_;
  HomeOnly<std::condition_variable> ended_;
  HomeProcess home_;
  std::exception_ptr error_;
  OwnThread thread_;  // must be last: it uses all other members
};

}  // namespace riffler::base
