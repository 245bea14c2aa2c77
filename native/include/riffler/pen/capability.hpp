// What an input device senses and what it can push with, coordinate by coordinate: the one description that pens, pucks
// and tablets share, and by which a session knows what the hand will not feel.
#pragma once

#include <array>
#include <limits>
#include <string>

#include "riffler/haptics/wrench.hpp"

namespace riffler::pen {

struct PenGeometry;

/// Along the device's x, y, z, and about three axes, see TurnAxes.
enum class Coordinate : unsigned char { X, Y, Z, A, B, C };

enum class Sensing : unsigned char {
  None,
  Position,  // mm, rad
  Rate,      // how far it is pushed sets a speed: pucks
};

/// What A, B and C turn about.
enum class TurnAxes : unsigned char {
  Device,  // the device's x, y, z
  Grip,    // C about the grip's own axis; A and B about two directions square to it, A the one most like the device's x
};

struct CoordinateCapability {
  Sensing sensing = Sensing::None;
  bool pushes = false;
  /// Of what is sensed, mm or rad (of rates mm/s or rad/s); infinite where nothing ends it or nothing is said.
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  double resolution = 0;            // the coarsest step of one count, in the home posture; 0: not said
  double peak = 0, continuous = 0;  // N or N·mm in the home posture, alone; 0 where it does not push
};

struct DeviceCapability {
  std::string name;
  TurnAxes turns = TurnAxes::Device;
  std::array<CoordinateCapability, haptics::kCoordinates> coordinates{};

  const CoordinateCapability& operator[](Coordinate c) const { return coordinates[static_cast<std::size_t>(c)]; }
  CoordinateCapability& operator[](Coordinate c) { return coordinates[static_cast<std::size_t>(c)]; }
  bool has_force() const;
};

/// "senses x y z a b c, pushes x y z a b; the hand does not feel: torque about the grip's axis"
std::string capability_text(const DeviceCapability& device);

/// What of a wrench the device has motors for, for renderable(): with the grip's axis (unit, device's frame) for the
/// third column where turns are about the grip, which then has a torque square to it only where both A and B push, and
/// forces only where X, Y and Z all do. Whether the motors are strong enough is another matter.
haptics::Capability pushed(const DeviceCapability& device, const Vec3& axis) noexcept;

/// Six coordinates sensed, five that push: strengths and resolutions from the motors, gears and encoders, at home, and
/// within the pen's limits. Its device frame is the arms' base frame.
DeviceCapability pen_capability(const PenGeometry& pen);

}  // namespace riffler::pen
