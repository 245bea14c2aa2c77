// The source's scheme for forces between two steps, with which haptic_run compares the loop.
#pragma once

#include "riffler/haptics/wrench.hpp"

namespace riffler::bench {

/// The source's (3.4): the force is computed every `period` s, in the cycle of the graphics, and the pen gets the
/// straight line between the last two values, so it is a whole period late.
class InterpolatedWrench {
 public:
  /// period > 0, s.
  explicit InterpolatedWrench(double period) : period_(period) {}

  /// Sets the newly computed wrench.
  void computed(const Wrench& wrench) { from_ = at(), to_ = wrench, age_ = 0; }
  /// Advances by dt (s) and returns the interpolated wrench.
  Wrench tick(double dt) {
    age_ += dt;
    return at();
  }

 private:
  Wrench at() const {
    const double t = age_ < period_ ? age_ / period_ : 1;
    return from_ + t * (to_ - from_);
  }

  double period_, age_ = 0;
  Wrench from_, to_;
};

}  // namespace riffler::bench
