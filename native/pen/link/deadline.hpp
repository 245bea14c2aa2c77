// A time by which something must be done.
#pragma once

#include <algorithm>
#include <chrono>

namespace riffler::pen {

class Deadline {
 public:
  /// `seconds` from now.
  explicit Deadline(double seconds)
      : end_(std::chrono::steady_clock::now() +
             std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(seconds))) {}
  /// Seconds left; 0 afterwards.
  double left() const {
    return std::max(0.0, std::chrono::duration<double>(end_ - std::chrono::steady_clock::now()).count());
  }

 private:
  std::chrono::steady_clock::time_point end_;
};

}  // namespace riffler::pen
