// The simulated pen as seen by the driver: a transport, and a clock that advances only by waiting.
#pragma once

#include <memory>

#include "pen/hid/hid_transport.hpp"
#include "pen/simulated/simulated_pen.hpp"

namespace riffler::pen {

/// Virtual time in whole µs: as fast as the machine computes, and the same from run to run.
class SimulatedClock final : public Clock {
 public:
  double now() noexcept override { return 1e-6 * static_cast<double>(time_us_); }
  /// Advances by at least a microsecond.
  void wait(double seconds) noexcept override;

 private:
  std::int64_t time_us_ = 0;
};

/// The pen's time follows the clock, from the creation of the transport: reads and writes advance it. All consecutive
/// transports of a pen share pen and clock.
class SimulatedTransport final : public HidTransport {
 public:
  /// `start`: the clock's time (s) at the pen's time 0.
  SimulatedTransport(std::shared_ptr<SimulatedPen> pen, std::shared_ptr<Clock> clock, double start = 0);

  int read(std::span<std::uint8_t> bytes, double seconds) noexcept override;
  bool write(std::span<const std::uint8_t> bytes) noexcept override;
  int get_feature(std::span<std::uint8_t> bytes) noexcept override;
  std::span<const std::uint8_t> descriptor() const noexcept override;

 private:
  void catch_up() noexcept;

  std::shared_ptr<SimulatedPen> pen_;
  std::shared_ptr<Clock> clock_;
  double start_;
};

}  // namespace riffler::pen
