#include "pen/simulated/stall_tolerant_clock.hpp"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include "pen/driver.hpp"

namespace riffler::pen {

StallTolerantClock::StallTolerantClock(double most)
    : StallTolerantClock(most, {steady_seconds, [](double seconds) {
                                  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
                                }}) {}

StallTolerantClock::StallTolerantClock(double most, System system)
    : system_(std::move(system)), most_(most), seen_(system_.now()), time_(seen_) {}

void StallTolerantClock::wait(double seconds) noexcept {
  if (!(seconds > 0)) return;
  now();
  system_.wait(seconds);
  pass(seconds + most_);
}

double StallTolerantClock::pass(double most) noexcept {
  const double now = system_.now(), since = now - std::exchange(seen_, now);
  time_.store(last() + std::clamp(since, 0.0, most), std::memory_order_relaxed);
  return last();
}

}  // namespace riffler::pen
