// State of the hand from one report of the device.
#pragma once

#include <array>
#include <cstdint>

#include "riffler/geom/pose.hpp"
#include "riffler/haptics/wrench.hpp"

namespace riffler::pen {

/// Trivially copyable, so that it can be passed between threads without locks. All zero before the first report.
struct PenSample {
  Pose pose{};                 ///< of the grip, in the pose frame
  double spin = 0;             ///< rad, of the grip about the pose's axis
  Vec3 velocity{0};            ///< mm/s, of the grip's pivot
  Vec3 turning{0};             ///< rad/s
  double time = 0;             ///< s on the driver's clock at which the report was read
  std::uint64_t sequence = 0;  ///< number of the report since opening, lost ones included; 0: none yet
  std::uint32_t buttons = 0;   ///< bit 0 is button 1
  std::uint32_t fault = 0;     ///< the device's own code; 0 is none
  bool late = false;           ///< the fault only reports that host or device was late; it heals
  double stretch = 0;          ///< mm of difference between two measurements of one length; 0 without redundancy
  /// Wrench that the motors applied when the report was sent, about the grip's pivot, if the device reports it. A
  /// wrench reaches the motors frames after its step, behind the device's own ramps and limits: only with this value is
  /// an account of energy right.
  Wrench applied{};
  bool says_applied = false;
  /// N·mm since opening that the friction of the device's own joints certainly took from motion; grows. 0 for a device
  /// whose friction was not identified (PassivitySettings then has what is known).
  double dissipated = 0;
  /// For a device with a PenGeometry: the counts that its counters would read if homing had preset them, in device
  /// order.
  std::array<std::int32_t, 6> counts{};
  /// For the same devices: mA that the motors applied when the report was sent, in device order.
  std::array<std::int16_t, 6> currents{};
  bool homed = false;    ///< the device knows its pose
  bool powered = false;  ///< the device is ready to push
};

}  // namespace riffler::pen
