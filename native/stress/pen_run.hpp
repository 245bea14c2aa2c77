// What minutes with the simulated pen share: a hand's gain, memory, and what each step asked the system for.
#pragma once

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <functional>

#include "pen/driver_loop.hpp"
#include "pen/simulated/simulated_pen.hpp"
#include "riffler/base/block_pool.hpp"

namespace riffler::stress {

/// MB that the process holds.
inline double resident_mb() {
  long pages = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  return static_cast<double>(resident) * 4096e-6;
}

/// Calls of operator new in steps after the warm-up, and blocks from the system.
struct StepCosts {
  long allocations = 0;
  std::uint64_t from_system = 0;
};

/// The loop, and what each of its steps asked the system for from `warm` (s) on.
class CountedStep final : public pen::PenStep {
 public:
  CountedStep(pen::PenStep& loop, std::function<long()> allocations, double warm, StepCosts& costs)
      : loop_(loop), allocations_(std::move(allocations)), warm_(warm), costs_(costs) {}
  haptics::SafeWrench step(const pen::PenSample& sample, double now, double dt) noexcept override {
    const long calls = allocations_();
    const std::uint64_t blocks = base::blocks_from_system();
    const haptics::SafeWrench out = loop_.step(sample, now, dt);
    if (now > warm_) {
      costs_.allocations += allocations_() - calls;
      costs_.from_system += base::blocks_from_system() - blocks;
    }
    return out;
  }

 private:
  pen::PenStep& loop_;
  std::function<long()> allocations_;
  double warm_;
  StepCosts& costs_;
};

/// What the hand gains in one contact, from motors without current to motors without current: between two nothing is
/// stored, so no spring gives back in one what it took in another.
struct ContactGain {
  double gained = 0, before = 0;
  std::int64_t pushed_us = 0;

  void add(const pen::SimulatedPen& pen) {
    const pen::PenEnergy energy = pen.arms().energy();
    const double net = energy.motors - energy.lost;
    if (pen.pushes()) pushed_us = pen.time_us();
    if (pen.time_us() - pushed_us > 10'000) before = net;
    gained = std::max(gained, net - before);
  }
};

/// The simulated pen is never gone.
struct NeverGone final : pen::Connector {
  void begin() noexcept override {}
  Answer poll(std::unique_ptr<pen::Transport>&, pen::OpenProblem&) noexcept override { return Answer::Pending; }
};

}  // namespace riffler::stress
