// Common parts of long runs with the simulated pen: the energy that a hand gains, memory, and allocations in steps.
#pragma once

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <functional>

#include "pen/driver_loop.hpp"
#include "pen/simulated/simulated_pen.hpp"
#include "riffler/base/block_pool.hpp"

namespace riffler::stress {

/// Resident memory of the process, MB.
inline double resident_mb() {
  long pages = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  return static_cast<double>(resident) * 4096e-6;
}

/// Calls of operator new and memory blocks taken from the system, in steps after the warm-up.
struct StepCosts {
  long allocations = 0;
  std::uint64_t from_system = 0;
};

/// A loop that counts allocations in its steps from `warm` (s) on.
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

/// Energy that the hand gains in one contact, between two times at which the motors have no current. No energy is
/// stored then, so a spring cannot return in one contact what it took in another.
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

/// A connector for the simulated pen, which never disconnects.
struct NeverGone final : pen::Connector {
  void begin() noexcept override {}
  Answer poll(std::unique_ptr<pen::Transport>&, pen::OpenProblem&) noexcept override { return Answer::Pending; }
};

}  // namespace riffler::stress
