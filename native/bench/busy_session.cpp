#include "bench/busy_session.hpp"

#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <thread>

#include "pen/driver.hpp"
#include "pen/simulated/simulated_device.hpp"
#include "riffler/base/block_pool.hpp"
#include "riffler/base/check.hpp"
#include "riffler/session/sculpt_loop.hpp"
#include "riffler/tool/cutters.hpp"

namespace riffler::bench {

namespace {

constexpr double kFrame = 0.033, kRamp = 0.5;  // s

/// Threads that compute until it is destroyed.
class Load {
 public:
  explicit Load(int threads) {
    for (int k = 0; k < threads; ++k)
      threads_.emplace_back([this] {
        double x = 1;
        while (!ending_.load(std::memory_order_relaxed))
          for (int n = 0; n < 1000; ++n) x = std::sqrt(x + n);
        sum_.store(x);
      });
  }
  ~Load() { ending_ = true; }
  Load(const Load&) = delete;
  Load& operator=(const Load&) = delete;

 private:
  std::atomic<bool> ending_{false};
  std::atomic<double> sum_{0};
  std::vector<std::jthread> threads_;  // last, because they use the other members
};

/// A loop that records when each of its steps began and ended.
class TimedLoop final : public pen::PenStep {
 public:
  TimedLoop(session::SculptLoop& loop, std::size_t most) : loop_(loop) { begins_.reserve(most), ends_.reserve(most); }

  haptics::SafeWrench step(const pen::PenSample& sample, double now, double dt) noexcept override {
    const double begin = pen::steady_seconds();
    const haptics::SafeWrench out = loop_.step(sample, now, dt);
    if (begins_.size() < begins_.capacity()) begins_.push_back(begin), ends_.push_back(pen::steady_seconds());
    return out;
  }

  /// Writes the times from `from` (s, of the same clock) on. Call it after the last step.
  void put(double from, BusyRun& run) const {
    for (std::size_t k = 1; k < begins_.size(); ++k) {
      if (begins_[k - 1] < from) continue;
      run.step.push_back(ends_[k] - begins_[k]);
      run.period.push_back(begins_[k] - begins_[k - 1]);
    }
  }

 private:
  session::SculptLoop& loop_;
  std::vector<double> begins_, ends_;
};

}  // namespace

BusyRun busy_session(const BusyOptions& options) {
  base::require_positive(options.seconds, "seconds");
  base::require_not_negative(options.load, "load");
  pen::DriverSettings driver;
  driver.real_time = options.real_time;
  const auto device = pen::SimulatedDevice::open({}, driver);
  const Volume stock = Volume::block({{{-30, -30, -20}, {30, 30, 0}}, 0.25, "z"});
  session::SculptLoopSettings settings;
  settings.workspace.dead_man_mask = 0;
  settings.carving.removal_constant = 0.01;
  settings.passivity = device->passivity();
  session::SculptLoop loop(settings, stock, cutters::ball(6, 30), nullptr, device->capability(),
                           Pose{{0, 0, 1}, {0, 0, 1}}, nullptr);
  const auto timed = std::make_shared<TimedLoop>(loop, static_cast<std::size_t>(1100 * (options.seconds + kRamp)));
  Volume shown = stock;
  base::BlockReserve reserve;
  std::vector<session::SculptLoop::Place> places;
  reserve.fill(1 << 17, 64);
  const Load load(options.load);
  device->set_step(timed);
  const double start = pen::steady_seconds(), end = start + kRamp + options.seconds;
  while (pen::steady_seconds() < end) {
    std::this_thread::sleep_for(std::chrono::duration<double>(kFrame));
    places.clear();
    loop.show(shown, places);
    reserve.fill(1 << 17, 64);
    for (session::SculptTick tick; loop.take(tick);) {
    }
  }
  BusyRun run;
  run.priority = device->priority();
  device->set_step(nullptr);
  timed->put(start + kRamp, run);
  return run;
}

}  // namespace riffler::bench
