#include "session/step_thread.hpp"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include "pen/driver.hpp"

namespace riffler::session {

namespace {

using Seconds = std::chrono::duration<double>;

constexpr double kTick = 1e-3;   // s
constexpr double kLater = 0.03;  // s that a device may be late with the ticks in which a force falls

}  // namespace

void StepThread::start(pen::Pen& pen, std::shared_ptr<pen::PenStep> step) {
  ending_ = false;
  polls_ = !pen.set_step(step);
  if (polls_) poller_ = base::OwnThread([this, &pen, step] { poll(pen, *step); });
}

void StepThread::wait(double fall, const std::function<bool()>& quiet) {
  for (double waited = 0; !quiet() && waited < fall + kLater; waited += kTick)
    std::this_thread::sleep_for(Seconds(kTick));
}

void StepThread::stop(pen::Pen& pen) {
  pen.set_step(nullptr);
  ending_ = true;
  poller_.join();
}

StepThread::~StepThread() {
  ending_ = true;
}

base::ThreadPriority StepThread::priority(const pen::Pen& pen) const {
  return polls_ ? priority_.get() : pen.priority();
}

/// A step of a device without force may take as long as it likes: the guard then makes this thread a normal one.
void StepThread::poll(pen::Pen& pen, pen::PenStep& step) noexcept {
  const auto tick = std::chrono::duration_cast<std::chrono::steady_clock::duration>(Seconds(kTick));
  const base::RealTimeScope scope(priority_);
  auto next = std::chrono::steady_clock::now();
  for (double last = pen::steady_seconds(); !ending_.load();) {
    const double now = pen::steady_seconds();
    step.step(pen.newest(), pen.now(), now - std::exchange(last, now));
    next = std::max(next + tick, std::chrono::steady_clock::now());
    std::this_thread::sleep_until(next);
  }
}

}  // namespace riffler::session
