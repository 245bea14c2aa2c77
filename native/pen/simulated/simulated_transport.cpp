#include "pen/simulated/simulated_transport.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace riffler::pen {

namespace {

std::int64_t micros(double seconds) {
  return std::llround(1e6 * seconds);
}

}  // namespace

void SimulatedClock::wait(double seconds) noexcept {
  time_us_ += std::max<std::int64_t>(1, micros(seconds));
}

SimulatedTransport::SimulatedTransport(std::shared_ptr<SimulatedPen> pen, std::shared_ptr<Clock> clock, double start)
    : pen_(std::move(pen)), clock_(std::move(clock)), start_(start) {}

void SimulatedTransport::catch_up() noexcept {
  pen_->advance(micros(clock_->now() - start_));
}

int SimulatedTransport::read(std::span<std::uint8_t> bytes, double seconds) noexcept {
  const double end = clock_->now() + seconds;
  for (;;) {
    catch_up();
    if (!pen_->plugged()) return -1;
    const double now = clock_->now();
    if (const std::size_t n = pen_->cable().read(micros(now - start_), bytes)) return static_cast<int>(n);
    if (now >= end) return 0;
    const double arrives = start_ + 1e-6 * static_cast<double>(pen_->cable().arrival_us(pen_->next_frame_us()));
    clock_->wait(std::min(end, arrives) - now);
  }
}

bool SimulatedTransport::write(std::span<const std::uint8_t> bytes) noexcept {
  catch_up();
  if (!pen_->plugged()) return false;
  pen_->cable().write(bytes);
  return true;
}

int SimulatedTransport::get_feature(std::span<std::uint8_t> bytes) noexcept {
  if (!pen_->plugged() || bytes.empty()) return -1;
  const std::size_t n = riffler_pen_feature(&pen_->config(), bytes[0], bytes.data(), bytes.size());
  return n == 0 ? -1 : static_cast<int>(n);
}

std::span<const std::uint8_t> SimulatedTransport::descriptor() const noexcept {
  return {riffler_pen_descriptor, riffler_pen_descriptor_size};
}

}  // namespace riffler::pen
