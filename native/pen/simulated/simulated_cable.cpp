#include "pen/simulated/simulated_cable.hpp"

#include <algorithm>
#include <utility>

#include "riffler/haptics/settings.hpp"

namespace riffler::pen {

namespace {
constexpr std::size_t kQueue = 64;  // as in hidraw
}

void CableSettings::validate() const {
  base::require_between(static_cast<double>(latency_us), 0, 1e6, "latency_us");
  base::require_between(static_cast<double>(jitter_us), 0, 1e6, "jitter_us");
  base::require_between(lost, 0, 1, "lost");
  base::require_between(doubled, 0, 1, "doubled");
  base::require_between(merged, 0, 1, "merged");
  base::require_between(lost_out, 0, 1, "lost_out");
}

SimulatedCable::SimulatedCable(const CableSettings& settings) : settings_(settings), random_(settings.seed) {
  settings_.validate();
}

void SimulatedCable::set(const CableSettings& settings) {
  settings.validate();
  if (settings.seed != settings_.seed) random_.seed(settings.seed);
  settings_ = settings;
}

/// A number in [0, 1), the same on every system, unlike the distributions of the standard library.
double SimulatedCable::draw() {
  return static_cast<double>(random_() >> 11) * 0x1p-53;
}

std::size_t SimulatedCable::receive(std::span<std::uint8_t> bytes) {
  if (taken_.empty()) return 0;
  const Report report = std::move(taken_.front());
  taken_.pop_front();
  std::copy_n(report.begin(), std::min(report.size(), bytes.size()), bytes.begin());
  return report.size();
}

void SimulatedCable::frame(std::int64_t now_us) {
  for (Report& report : written_) {
    ++counts_.sent_out;
    if (draw() < settings_.lost_out)
      ++counts_.lost_out;
    else
      taken_.push_back(std::move(report));
  }
  written_.clear();
  if (waiting_.empty()) return;
  Report report = std::exchange(waiting_, {});
  // Always the same number of draws, so that changing one fraction does not affect the other effects.
  const double lost = draw(), doubled = draw(), merged = draw();
  ++counts_.sent;
  if (lost < settings_.lost) {
    ++counts_.lost;
    return;
  }
  if (merged < settings_.merged) {
    ++counts_.merged;
    held_.insert(held_.end(), report.begin(), report.end());
    return;
  }
  report.insert(report.begin(), held_.begin(), held_.end());
  held_.clear();
  if (doubled < settings_.doubled) {
    ++counts_.doubled;
    arrive(now_us, report);
  }
  arrive(now_us, std::move(report));
}

void SimulatedCable::arrive(std::int64_t now_us, Report report) {
  const auto late = static_cast<std::int64_t>(draw() * static_cast<double>(settings_.jitter_us));
  std::int64_t time = now_us + settings_.latency_us + late;
  if (!arrivals_.empty()) time = std::max(time, arrivals_.back().time_us);
  if (arrivals_.size() == kQueue) arrivals_.pop_front(), ++counts_.overrun;
  arrivals_.push_back({time, std::move(report)});
}

std::size_t SimulatedCable::read(std::int64_t now_us, std::span<std::uint8_t> bytes) {
  if (arrivals_.empty() || arrivals_.front().time_us > now_us) return 0;
  const Report report = std::move(arrivals_.front().bytes);
  arrivals_.pop_front();
  const std::size_t size = std::min(report.size(), bytes.size());
  std::copy_n(report.begin(), size, bytes.begin());
  return size;
}

std::int64_t SimulatedCable::arrival_us(std::int64_t next_frame_us) const {
  const std::int64_t unsent = next_frame_us + settings_.latency_us;
  return arrivals_.empty() ? unsent : std::min(arrivals_.front().time_us, unsent);
}

void SimulatedCable::clear() {
  waiting_.clear(), held_.clear(), arrivals_.clear(), written_.clear(), taken_.clear();
}

}  // namespace riffler::pen
