// Joint speeds from counters and times.
#pragma once

#include <array>
#include <cstdint>

#include "riffler/pen/arms/kinematics.hpp"

namespace riffler::pen {

/// Per counter, the slope of the longest line through the newest reading and an older one such that no reading between
/// them deviates by more than a count: first-order adaptive windowing with end fit (Janabi-Sharifi, Hayward and Chen,
/// "Discrete-time adaptive windowing for velocity estimation", IEEE Trans. Control Systems Technology 8(6), 2000). A
/// steady motion is averaged over the whole window, with an error below a count over its duration, and a change is
/// followed at once. The difference of two readings at 1 kHz could be wrong by a count per millisecond, 24 mm/s at the
/// end of a 180 mm arm. Counters may wrap. Allocates nothing.
class CountSpeed {
 public:
  explicit CountSpeed(const PenGeometry& pen) noexcept : channels_(pen.channels) {}

  /// `time`: s on the device's clock. Ignores readings that are not later than the one before, or whose time is not
  /// finite.
  void add(const EncoderCounts& raw, double time) noexcept;
  /// Clears all readings: after a gap or a homing.
  void clear() noexcept { size_ = 0; }

  /// rad/s of R and L; zeros before the second reading.
  JointAngles rates() const noexcept;

 private:
  static constexpr std::size_t kWindow = 20;

  double counts_per_second(std::size_t channel) const noexcept;
  /// Index of the reading of this age; 0 is the newest.
  std::size_t slot(std::size_t age) const noexcept { return (newest_ + kWindow - age) % kWindow; }

  std::array<PenChannel, kPenChannels> channels_;
  std::array<EncoderCounts, kWindow> raw_{};
  std::array<double, kWindow> time_{};
  std::size_t newest_ = 0, size_ = 0;
};

}  // namespace riffler::pen
