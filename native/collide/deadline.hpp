// Deadline of a time budget.
#pragma once

#include <chrono>
#include <optional>

namespace riffler::collide {

/// Tells when to stop, by the monotonic clock, which it reads rarely. Without a budget it never passes.
class Deadline {
 public:
  using Clock = std::chrono::steady_clock;
  Deadline() = default;
  explicit Deadline(Clock::time_point end) : end_(end) {}
  /// Whether the deadline has passed. Reads the clock at every eighth call.
  bool passed() { return end_ && (passed_ = passed_ || (++calls_ % 8 == 0 && Clock::now() >= *end_)); }

 private:
  std::optional<Clock::time_point> end_;
  unsigned calls_ = 0;
  bool passed_ = false;
};

}  // namespace riffler::collide
