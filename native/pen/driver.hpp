// The thread that owns an open device, and a second thread that reconnects a lost one.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "base/own_thread.hpp"
#include "base/steady_clock.hpp"
#include "pen/driver_loop.hpp"
#include "riffler/base/thread_priority.hpp"

namespace riffler::pen {

class Driver {
 public:
  /// Finds, opens and checks the device; throws OpenError. Called in its own thread, one call at a time, never while
  /// the driver's thread uses the model.
  using Open = std::function<std::unique_ptr<Transport>()>;

  /// Starts the threads. `transport`: as in DriverLoop. `clock`: the device's own, read only by the driver's thread;
  /// null: the system clock. Throws std::invalid_argument for invalid settings, std::system_error if no thread can be
  /// created.
  Driver(std::shared_ptr<PenModel> model, std::shared_ptr<PenStep> step, std::unique_ptr<Transport> transport,
         Open open, const DriverSettings& settings = {}, std::shared_ptr<Clock> clock = nullptr);
  /// As stop().
  ~Driver();
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;

  /// Stops pushing, closes the device and ends both threads. Returns false if a blocking system call makes that take
  /// longer than `seconds`: the threads then end by themselves when it returns. Also false in a process forked from
  /// that of the threads, which does not own the device.
  bool stop(double seconds = 2);

  /// As of the last tick. Any thread; never waits.
  LinkStatus status() const noexcept;
  /// Why the last attempt to connect failed, or empty. Any thread but the driver's.
  std::string problem() const;
  /// How the system runs the driver's thread. Any other thread.
  base::ThreadPriority priority() const;

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
  base::HomeProcess home_;
};

using base::steady_seconds;

}  // namespace riffler::pen
