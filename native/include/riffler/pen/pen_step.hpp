// The computation of one tick of a pen.
#pragma once

#include "riffler/haptics/safety.hpp"
#include "riffler/pen/sample.hpp"

namespace riffler::pen {

/// Called once per tick of an open device, from the driver's thread: it must not wait or allocate.
class PenStep {
 public:
  virtual ~PenStep() = default;
  /// Returns the wrench to push until the next step. `now` and `dt` (time since the last step) are in s on the driver's
  /// clock; sample.time gives the age of the sample. dt = 0 only in the first step after a connection, or after a
  /// change of the step.
  virtual haptics::SafeWrench step(const PenSample& sample, double now, double dt) noexcept = 0;
};

}  // namespace riffler::pen
