// The time of a device that is simulated on this machine: it stands still while the machine does.
#pragma once

#include <atomic>
#include <functional>

#include "pen/hid/transport.hpp"

namespace riffler::pen {

/// The system's seconds, but no more than `most` from one look to the next beside what was waited for. Where the thread
/// that looks is kept from running, the rest of that time has not been: everything goes on more slowly, nothing is
/// late.
class StallTolerantClock final : public Clock {
 public:
  /// The system's clock and its waiting; for tests another one's.
  struct System {
    std::function<double()> now;
    std::function<void(double)> wait;
  };

  explicit StallTolerantClock(double most = 5e-4);
  StallTolerantClock(double most, System system);

  // By one thread.
  double now() noexcept override { return pass(most_); }
  void wait(double seconds) noexcept override;

  /// As of the last look. Any thread.
  double last() const noexcept { return time_.load(std::memory_order_relaxed); }

 private:
  double pass(double most) noexcept;

  System system_;
  double most_, seen_;
  std::atomic<double> time_;
};

}  // namespace riffler::pen
