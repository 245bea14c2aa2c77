// Description of a pen: lengths, gears, encoders, motors and limits (pen/arms/description.hpp reads them from TOML).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "riffler/geom/vec.hpp"

namespace riffler::pen {

/// The right arm stands at y = +L0 of the base frame, the left one at y = −L0. Used as array indices.
enum class Arm : unsigned char { R = 0, L = 1 };

constexpr std::size_t index(Arm arm) {
  return static_cast<std::size_t>(arm);
}

/// Lengths of one arm, mm: (2.1), (2.2).
struct ArmLinks {
  double shoulder;  // y of the vertical axis: +L0 or −L0
  double upper;     // L1
  double fore;      // L2
};

/// One motor with its encoder, gear and joint.
struct PenChannel {
  Arm arm = Arm::R;
  int joint = 0;     // 0, 1, 2: θ1, θ2, θ3
  double steps = 0;  // counts per turn of the joint
  double ratio = 0;  // turns of the motor per turn of the joint
  int sign = 1;      // sign of count and command for positive joint rotation
  std::int32_t home = 0;
  double low = 0, high = 0;                                              // rad, of the joint
  double torque_constant = 0, peak_current = 0, continuous_current = 0;  // N·mm/A, A
  double coulomb = 0, viscous = 0;                                       // N·mm and N·mm·s/rad at the motor
  double gravity = 0;     // N·mm at the joint while its link is horizontal
  double inertia = 0;     // kg·mm² at the joint: rotor (through the gear) and links
  double resistance = 0;  // Ω of the winding

  double peak_torque() const { return torque_constant * peak_current; }  // N·mm at the motor
  double continuous_torque() const { return torque_constant * continuous_current; }
};

constexpr std::size_t kPenChannels = 6;

/// A digital-to-analogue converter board in front of the amplifiers, with two's complement values.
struct Converter {
  int bits = 0;
  std::array<double, kPenChannels> slope{}, offset{};  // steps per N·mm at the motor, and steps at zero torque

  int lowest() const { return -(1 << (bits - 1)); }
  int highest() const { return (1 << (bits - 1)) - 1; }
};

/// Standard uncertainties of values that were identified on the pen, in the device's order and the units of PenChannel.
struct PenUncertainty {
  std::array<double, kPenChannels> torque_constant{}, coulomb{}, viscous{}, gravity{};
};

/// A pen of two arms with three joints each, and a grip between the arms' ends.
struct PenGeometry {
  std::string name, description;
  Mat3 turn{1};    // A of (2.3): rotation from the base frame to the pose frame
  Vec3 origin{0};  // p
  std::array<ArmLinks, 2> arms{};
  double grip_length = 0, grip_tolerance = 0;  // mm
  double grip_mass = 0, grip_inertia = 0;      // kg; kg·mm² about a perpendicular through its middle
  Arm tip = Arm::L;                            // the arm whose end is nearer to the tool's tip
  double probe_steps = 0;                      // counts per turn
  std::int32_t probe_home = 0;
  int probe_sign = 1;
  std::array<PenChannel, kPenChannels> channels{};  // in the device's order
  std::optional<Converter> converter;
  std::optional<PenUncertainty> uncertainty;  // of a pen that was identified; without it its values are assumptions
  double elbow_low = 0, elbow_high = 0;       // rad: θ2 − θ3
  Box3 workspace{};                           // of the grip's middle, base frame, mm
  double force = 0, torque = 0;               // N, N·mm: limits on the hand
  double speed = 0, turn_rate = 0;            // mm/s, rad/s
  double friction_speed = 0;                  // rad/s at the motor
};

}  // namespace riffler::pen
