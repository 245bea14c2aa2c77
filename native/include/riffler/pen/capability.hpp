// What an input device senses and pushes, per coordinate. Pens, pucks and tablets share this description; from it a
// session knows what the hand will not feel.
#pragma once

#include <array>
#include <limits>
#include <string>

#include "riffler/haptics/wrench.hpp"

namespace riffler::pen {

struct PenGeometry;

/// Along the device's x, y, z, and about three axes; see TurnAxes.
enum class Coordinate : unsigned char { X, Y, Z, A, B, C };

/// What is sensed of a coordinate.
enum class Sensing : unsigned char {
  None,
  Position,  // mm, rad
  Rate,      // the deflection sets a speed: pucks
};

/// The axes of A, B and C.
enum class TurnAxes : unsigned char {
  Device,  // the device's x, y, z
  Grip,    // C about the grip's own axis; A and B about two perpendiculars, A the one closest to the device's x
};

/// Sensing and force of one coordinate.
struct CoordinateCapability {
  Sensing sensing = Sensing::None;
  bool pushes = false;
  /// Range of the sensed value, mm or rad (for rates mm/s or rad/s); infinite if unlimited or unknown.
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  double resolution = 0;            // coarsest step of one count in the home posture; 0: unknown
  double peak = 0, continuous = 0;  // N or N·mm in the home posture, one coordinate alone; 0: does not push
};

/// Name and six coordinates of a device.
struct DeviceCapability {
  std::string name;
  TurnAxes turns = TurnAxes::Device;
  std::array<CoordinateCapability, haptics::kCoordinates> coordinates{};

  const CoordinateCapability& operator[](Coordinate c) const { return coordinates[static_cast<std::size_t>(c)]; }
  CoordinateCapability& operator[](Coordinate c) { return coordinates[static_cast<std::size_t>(c)]; }
  /// Whether the device pushes any coordinate.
  bool has_force() const;
};

/// For example "senses x y z a b c, pushes x y z a b; the hand does not feel: torque about the grip's axis".
std::string capability_text(const DeviceCapability& device);

/// The coordinates for which the device has motors, as input of renderable(). `axis`: the grip's axis (unit, device
/// frame); it becomes the third column where rotations are about the grip. Such a device has torques perpendicular to
/// the grip only if both A and B push, and forces only if X, Y and Z all do. The strength of the motors is not
/// considered.
haptics::Capability pushed(const DeviceCapability& device, const Vec3& axis) noexcept;

/// Capability of a two-arm pen: senses six coordinates, pushes five. Strengths and resolutions follow from motors,
/// gears and encoders in the home posture, within the pen's limits. The device frame is the base frame of the arms.
DeviceCapability pen_capability(const PenGeometry& pen);

}  // namespace riffler::pen
