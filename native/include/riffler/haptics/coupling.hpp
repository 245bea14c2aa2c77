// Virtual coupling: a spring and a damper between the device's pose and the tool's (Colgate, Stanley and Brown 1995).
// The device feels only the coupling, so the stiffness that it has to render is known and independent of contacts.
#pragma once

#include "riffler/geom/pose.hpp"
#include "riffler/haptics/wrench.hpp"

namespace riffler::haptics {

/// Stiffness, damping and limits of the virtual coupling.
struct CouplingSettings {
  double stiffness = 1;         ///< N/mm
  double damping = 1e-3;        ///< N·s/mm
  double turn_stiffness = 2e3;  ///< N·mm/rad
  double turn_damping = 2;      ///< N·mm·s/rad
  double max_stretch = 5;       ///< mm; beyond it the spring force stays constant
  double max_turn = 0.5;        ///< rad, at most π/2; beyond it the spring torque stays constant

  /// Throws std::invalid_argument naming the field.
  void validate() const;
  /// The coupling at the tool that the hand feels as this one: there displacements are `scale` times as long, and
  /// forces come back times the scale.
  CouplingSettings at_tool(double scale) const;
  /// Largest energy that the spring stores, N·mm, for a stretch of `longest` mm and the worst rotation.
  double capacity(double longest) const;
};

/// Pose of a body without rotational symmetry.
struct RigidFrame {
  Vec3 point{0};
  Mat3 axes{1};  ///< orthonormal, right-handed; columns in the part frame
};

/// Motion that takes the tool to the device's pose.
struct PoseError {
  Vec3 translation{0};  ///< mm
  Vec3 rotation{0};     ///< rotation vector, rad, of length 0 … π
};

/// For two bodies of revolution: the smallest rotation from axis to axis. For opposite axes it is not unique; one of
/// them is returned.
PoseError pose_error(const Pose& device, const Pose& tool);
/// For two bodies without rotational symmetry: the full rotation between their frames.
PoseError pose_error(const RigidFrame& device, const RigidFrame& tool);

/// Both wrenches about the device's point. They are equal and opposite, so the coupling adds no momentum.
struct CouplingWrenches {
  Wrench on_device, on_tool;
  double energy;  ///< N·mm stored in the spring
};

/// Wrenches of the coupling for a pose error `stretch`. `device` and `tool`: twists of the two bodies about the
/// device's point (use `moved` to shift the pivot).
/// The spring torque is continuous in both poses: beyond π − max_turn it falls to zero at π, where its direction is
/// undefined, as every continuous torque against the rotation must. Spring forces are the gradient of `energy`.
CouplingWrenches couple(const CouplingSettings& settings, const PoseError& stretch, const Twist& device,
                        const Twist& tool);

}  // namespace riffler::haptics
