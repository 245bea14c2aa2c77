// Runs the step of a loop: in the device's own thread, or in one that polls the device.
#pragma once

#include <atomic>
#include <functional>
#include <memory>

#include "base/own_thread.hpp"
#include "base/real_time.hpp"
#include "riffler/pen/device.hpp"

namespace riffler::session {

/// Starts and stops the ticks of one step. Functions are for one thread.
class StepThread {
 public:
  /// In the device's thread, or, if it has none, a thousand times a second. `pen` must outlive the ticks.
  void start(pen::Pen& pen, std::shared_ptr<pen::PenStep> step);
  /// On return the step is no longer called. The force of `loop` falls to zero first, if its device takes no longer
  /// than `fall` (s) and some ticks for that; otherwise it ends with the step.
  template <class Loop>
  void stop(pen::Pen& pen, Loop& loop, double fall) {
    loop.let_go();
    wait(fall, [&loop] { return loop.quiet(); });
    stop(pen);
  }
  ~StepThread();
  /// How the system runs the thread of the steps.
  base::ThreadPriority priority(const pen::Pen& pen) const;

 private:
  void stop(pen::Pen& pen);
  static void wait(double fall, const std::function<bool()>& quiet);
  void poll(pen::Pen& pen, pen::PenStep& step) noexcept;

  std::atomic<bool> ending_{false};
  bool polls_ = false;
  base::PriorityReport priority_;
  base::OwnThread poller_;
};

}  // namespace riffler::session
