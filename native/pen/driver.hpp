// The thread that owns an open device, and the one that finds the device again when it is gone.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "base/own_thread.hpp"
#include "pen/driver_loop.hpp"

namespace riffler::pen {

class Driver {
 public:
  /// Finds, opens and checks the device; throws OpenError. Called in a thread of its own, one call at a time, never
  /// while the driver's thread uses the model.
  using Open = std::function<std::unique_ptr<Transport>()>;

  /// Starts. `transport` as in DriverLoop. `clock`: the device's own, looked at by the driver's thread alone, or null:
  /// the system's. Throws std::invalid_argument for settings, std::system_error where no thread can be had.
  Driver(std::shared_ptr<HidModel> model, std::shared_ptr<PenStep> step, std::unique_ptr<Transport> transport,
         Open open, const DriverSettings& settings = {}, std::shared_ptr<Clock> clock = nullptr);
  /// As stop().
  ~Driver();
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;

  /// The device is told not to push and closed, and both threads end. False where that takes longer than `seconds`, a
  /// system call that does not come back: the threads are then left to themselves, and end when it does. Nor in a
  /// process that was forked from that of the threads: the device is not its own.
  bool stop(double seconds = 2);

  /// As of the last tick. Any thread; never waits.
  LinkStatus status() const noexcept;
  /// Why the last attempt to connect failed, or nothing. Any thread but the driver's.
  std::string problem() const;

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
  base::HomeProcess home_;
};

/// Of the system: std::chrono::steady_clock.
double steady_seconds() noexcept;

}  // namespace riffler::pen
