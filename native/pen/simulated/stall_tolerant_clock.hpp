// Clock of a device simulated on this machine: it stops while the machine stalls.
#pragma once

#include <atomic>
#include <functional>

#include "pen/link/transport.hpp"

namespace riffler::pen {

/// The system's time, but advancing by at most `most` (s) between two reads, plus the time waited. If the reading
/// thread is kept from running, the excess is dropped: everything gets slower, but nothing is late.
class StallTolerantClock final : public Clock {
 public:
  /// The system's clock and wait function; replaced in tests.
  struct System {
    std::function<double()> now;
    std::function<void(double)> wait;
  };

  explicit StallTolerantClock(double most = 5e-4);
  StallTolerantClock(double most, System system);

  // By one thread.
  double now() noexcept override { return pass(most_); }
  void wait(double seconds) noexcept override;

  /// As of the last read. Any thread.
  double last() const noexcept { return time_.load(std::memory_order_relaxed); }

 private:
  double pass(double most) noexcept;

  System system_;
  double most_, seen_;
  std::atomic<double> time_;
};

}  // namespace riffler::pen
