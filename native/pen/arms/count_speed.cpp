#include "pen/arms/count_speed.hpp"

#include <cmath>

#include "geom/math.hpp"

namespace riffler::pen {

namespace {

// Counts. Readings are rounded down, so those of a steady motion deviate by less than one. One that trembles at the
// edge of a count deviates by exactly one, and is not motion.
constexpr double kOff = 1 + 1e-9;

}  // namespace

void CountSpeed::add(const EncoderCounts& raw, double time) noexcept {
  if (!std::isfinite(time) || (size_ > 0 && !(time > time_[newest_]))) return;
  newest_ = (newest_ + 1) % kWindow;
  raw_[newest_] = raw, time_[newest_] = time;
  if (size_ < kWindow) ++size_;
}

double CountSpeed::counts_per_second(std::size_t channel) const noexcept {
  // Counts and time since the reading of this age; differences of wrapping counters are right.
  std::array<double, kWindow> count{}, time{};
  double slope = 0;
  for (std::size_t age = 1; age < size_; ++age) {
    const auto now = static_cast<std::uint32_t>(raw_[newest_][channel]);
    count[age] = static_cast<std::int32_t>(now - static_cast<std::uint32_t>(raw_[slot(age)][channel]));
    time[age] = time_[newest_] - time_[slot(age)];
    const double longer = count[age] / time[age];
    for (std::size_t k = 1; k < age; ++k)
      if (std::abs(count[k] - longer * time[k]) > kOff) return slope;
    slope = longer;
  }
  return slope;
}

JointAngles CountSpeed::rates() const noexcept {
  JointAngles out{};
  for (std::size_t k = 0; k < kPenChannels; ++k) {
    const PenChannel& c = channels_[k];
    out[index(c.arm)][c.joint] = c.sign * counts_per_second(k) / c.steps * 2 * kPi;
  }
  return out;
}

}  // namespace riffler::pen
