// The messages between the driver and the program that drives an arm by its maker's library: what the library reports
// of the arm, and the wrench for it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "riffler/geom/vec.hpp"

namespace riffler::pen {

/// One reading, in Riffler's units and axes: x right, y away from the user, z up.
struct ArmState {
  Vec3 position{0};  // mm
  Vec3 velocity{0};  // mm/s
  Mat3 frame{1};     // columns: the grip's own axes; only if the arm senses its orientation
  std::uint32_t buttons = 0;
  std::uint32_t fault = 0;  // the library's own code; 0 is none
  bool calibrated = false;
  bool powered = false;  // ready to push
};

/// What the motors shall do.
struct ArmCommand {
  Vec3 force{0};   // N
  Vec3 torque{0};  // N·mm
};

/// What is constant of an arm.
struct ArmTraits {
  std::string name, serial;
  std::string about;        // for users
  Vec3 own_axis{0};         // in the grip's frame, from the tip to its end; zero: no orientation is sensed
  double force = 0;         // N, largest along any direction
  double continuous = 0;    // N, for long
  double torque = 0;        // N·mm about any axis; 0: no motors for torque
  Vec3 lower{0}, upper{0};  // mm, of the workspace; both zero: unknown
};

}  // namespace riffler::pen
