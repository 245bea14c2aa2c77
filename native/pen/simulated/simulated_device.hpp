// The simulated pen as a device that anyone can pick: in the driver's own thread, and as fast as the machine keeps up.
#pragma once

#include <memory>

#include "pen/hid_pen.hpp"
#include "pen/simulated/simulated_pen.hpp"
#include "pen/simulated/stall_tolerant_clock.hpp"
#include "riffler/pen/arms/compensation.hpp"

namespace riffler::pen {

inline constexpr const char* kSimulatedKind = "simulated";
inline constexpr const char* kSimulatedWhat = "Riffler pen without hardware, moved by a simulated hand";

/// Its time is a StallTolerantClock's: no force is taken away from a hand that this machine moves because the machine
/// is busy.
class SimulatedDevice final : public HidPen {
 public:
  /// Homed. Its hand goes round on a curve (hand_on_a_curve) until it is told where to go.
  static std::unique_ptr<SimulatedDevice> open(const SimulatedPenSettings& settings = {},
                                               const DriverSettings& driver = {},
                                               const Compensation& compensation = {});

  double now() const noexcept override { return clock_->last(); }

  /// The hand goes there at its own haste, as far as the arms reach; it lets go where the grip is 0. By one thread;
  /// never waits. std::invalid_argument for what is not finite, an axis without length, a grip outside 0 to 1.
  void aim(const HandWish& wish);
  /// On the curve again. By the same thread.
  void wander() noexcept;
  /// From now on a counter reads `counts` too few, as an encoder that loses them one by one; of the pen as it was made,
  /// not of what it has lost by now. Any thread. std::invalid_argument for a channel that is not there.
  void lose(std::size_t channel, std::int32_t counts);

 private:
  struct Hand;
  struct Losses;
  SimulatedDevice(std::shared_ptr<Hand> hand, std::shared_ptr<Losses> losses, std::shared_ptr<HidModel> model,
                  std::unique_ptr<Transport> transport, Driver::Open open, const DriverSettings& driver,
                  std::shared_ptr<StallTolerantClock> clock);

  std::shared_ptr<Hand> hand_;
  std::shared_ptr<Losses> losses_;
  std::shared_ptr<StallTolerantClock> clock_;
};

}  // namespace riffler::pen
