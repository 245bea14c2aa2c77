// What the safety checks see of a sample.
#pragma once

#include "riffler/haptics/safety.hpp"
#include "riffler/pen/sample.hpp"

namespace riffler::pen {

/// `now` on the clock of the samples and `dt` since the last tick, s; `dead_man`: the switch is held.
inline haptics::Observation observation_of(const PenSample& sample, double now, double dt, bool dead_man) {
  return {.dt = dt,
          .age = now - sample.time,
          .pose = sample.pose,
          .twist = {sample.velocity, sample.turning},
          .redundancy = sample.stretch,
          .homed = sample.homed,
          .dead_man = dead_man,
          .device_fault = sample.fault,
          .device_late = sample.late};
}

}  // namespace riffler::pen
