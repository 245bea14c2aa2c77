// What the hand does, as of one report.
#pragma once

#include <array>
#include <cstdint>

#include "riffler/geom/pose.hpp"
#include "riffler/haptics/wrench.hpp"

namespace riffler::pen {

/// Trivially copyable, so that it passes between threads without locks. All of it is zero before the first report.
struct PenSample {
  Pose pose{};       ///< of the grip, in the frame of poses
  double spin = 0;   ///< rad, of the grip about the pose's axis
  Vec3 velocity{0};  ///< mm/s, of the grip's pivot
  Vec3 turning{0};   ///< rad/s
  double time = 0;   ///< s of the driver's clock: when the report was read
  std::uint64_t sequence =
      0;                      ///< of the report since the device was opened, those that were lost included; 0: none yet
  std::uint32_t buttons = 0;  ///< bit 0 is button 1
  std::uint32_t fault = 0;    ///< the device's own code; 0 is none
  bool late = false;          ///< the fault only says that the host or the device was late: it heals
  double stretch = 0;         ///< mm between two measurements of one length; 0 where nothing is measured twice
  /// What the hand felt of the motors when the report was sent, about the grip's pivot, where the device says it. A
  /// wrench comes to the motors frames after the step that asked for it, behind the device's own ramps and limits: an
  /// account of energy is right with this, and wrong with what was asked for.
  Wrench applied{};
  bool says_applied = false;
  /// Of a device with a PenGeometry: what its counters would read had homing preset them, in its own order.
  std::array<std::int32_t, 6> counts{};
  bool homed = false;    ///< the pose is sure
  bool powered = false;  ///< the device is ready to push
};

}  // namespace riffler::pen
