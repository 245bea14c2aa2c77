// The computation of one tick of a pen.
#pragma once

#include "riffler/haptics/safety.hpp"
#include "riffler/pen/sample.hpp"

namespace riffler::pen {

/// Called once in each tick of an open device; from the driver's thread, so it must not wait or allocate.
class PenStep {
 public:
  virtual ~PenStep() = default;
  /// The wrench to push with until the next step. `now` and `dt`, the time since the last step, are the driver's
  /// clock's; sample.time says how old the sample is. The first step after a connection, or with a device that had
  /// another step before, has dt = 0, and no other has.
  virtual haptics::SafeWrench step(const PenSample& sample, double now, double dt) noexcept = 0;
};

}  // namespace riffler::pen
