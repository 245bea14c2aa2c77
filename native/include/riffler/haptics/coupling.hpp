// Virtual coupling: a spring and a damper between the device's pose and the tool's (Colgate, Stanley and Brown 1995).
// The device feels the coupling alone, so what it can be given to hold has a known stiffness, whatever the tool
// touches.
#pragma once

#include "riffler/geom/pose.hpp"
#include "riffler/haptics/wrench.hpp"

namespace riffler::haptics {

struct CouplingSettings {
  double stiffness = 1;         ///< N/mm
  double damping = 1e-3;        ///< N·s/mm
  double turn_stiffness = 2e3;  ///< N·mm/rad
  double turn_damping = 2;      ///< N·mm·s/rad
  double max_stretch = 5;       ///< mm; the spring's force grows no further beyond
  double max_turn = 0.5;        ///< rad, at most π/2; the spring's torque grows no further beyond

  /// std::invalid_argument naming the field.
  void validate() const;
  /// N·mm: the most that the spring holds, for a stretch of `longest` mm and the worst turn.
  double capacity(double longest) const;
};

/// A body that does not look the same all round.
struct RigidFrame {
  Vec3 point{0};
  Mat3 axes{1};  ///< orthonormal, right-handed; columns in the part frame
};

/// How far the device is ahead of the tool: what would take the tool to the device.
struct PoseError {
  Vec3 translation{0};  ///< mm
  Vec3 rotation{0};     ///< rotation vector, rad, of length 0 … π
};

/// Of two bodies of revolution: the shortest turn from axis to axis. Opposite axes have no shortest turn: one of them.
PoseError pose_error(const Pose& device, const Pose& tool);
PoseError pose_error(const RigidFrame& device, const RigidFrame& tool);

/// Both wrenches about the device's point: equal and opposite, so the coupling adds no momentum.
struct CouplingWrenches {
  Wrench on_device, on_tool;
  double energy;  ///< N·mm in the spring
};

/// The spring's torque is continuous in both poses, everywhere: beyond π − max_turn it falls to zero at π, where its
/// direction is undefined, as every continuous torque that opposes the turn must. Spring forces are the gradient of
/// `energy`. `device` and `tool` are the twists of the two bodies about the device's point (`moved` brings them there).
CouplingWrenches couple(const CouplingSettings& settings, const PoseError& stretch, const Twist& device,
                        const Twist& tool);

}  // namespace riffler::haptics
