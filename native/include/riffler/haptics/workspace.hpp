// Mapping between the grip's frame and the tool's: poses forward, wrenches back to the hand.
#pragma once

#include <cstdint>

#include "riffler/geom/pose.hpp"
#include "riffler/haptics/wrench.hpp"

namespace riffler::haptics {

/// Mapping from grip to tool, and the device's switches.
struct WorkspaceSettings {
  double scale = 1;                 ///< mm of the tool per mm of the grip
  Mat3 turn{1};                     ///< orthonormal, right-handed: the grip's frame → the part's
  std::uint32_t clutch_mask = 2;    ///< any of these buttons is the clutch; 0: no clutch
  std::uint32_t dead_man_mask = 1;  ///< any of these buttons is the dead-man switch; 0: no dead-man switch
  double pivot = 0;                 ///< mm above the tip, on the tool's axis: the point that follows the grip's (4.6)

  /// Throws std::invalid_argument naming the field.
  void validate() const;
  /// `absolute`: a device whose poses are the tool's, such as a tablet: it leads the tip.
  WorkspaceSettings for_device(bool absolute) const {
    WorkspaceSettings out = *this;
    if (absolute) out.pivot = 0;
    return out;
  }
};

/// The tool's target follows the grip, rotated and scaled about a pair of corresponding poses. Every change makes the
/// last grip and the last target the new pair, so the target never jumps: not when the clutch is pressed or released,
/// nor when scale or view change. The grip's point leads the point `pivot` above the tip: the tool turns about it, and
/// the hand's torque is about it. While the clutch is pressed the target stands still. Afterwards grip and target may
/// differ in orientation; both then make the same rotations.
class Workspace {
 public:
  /// Throws std::invalid_argument for invalid settings.
  explicit Workspace(const WorkspaceSettings& settings = {});

  /// Makes the next grip correspond to `target`.
  void place(const Pose& target);
  /// Throws std::invalid_argument naming the field and then changes nothing.
  void set(const WorkspaceSettings& settings);
  const WorkspaceSettings& settings() const { return settings_; }

  /// The target for the grip of this tick. For a grip that is not finite or has no axis: the last target.
  Pose target(const Pose& grip, std::uint32_t buttons);
  /// Whether the dead-man switch is held. Always true if the device has none.
  bool dead_man(std::uint32_t buttons) const {
    return settings_.dead_man_mask == 0 || (buttons & settings_.dead_man_mask) != 0;
  }

  /// Twist of the grip in the target's frame. Zero while the clutch is pressed.
  Twist to_target(const Twist& grip) const;
  /// Wrench on the target, converted to the grip. Scaled like displacements, so the work at the hand equals the work at
  /// the tool. Zero while the clutch is pressed.
  Wrench to_grip(const Wrench& target) const;

 private:
  void pair_here();

  WorkspaceSettings settings_;
  Pose grip_, target_;  // of the last tick
  Pose grip_pair_, target_pair_;
  Mat3 aslant_{1};  // rotation from settings_.turn · grip axis to target axis
  bool clutched_ = false, begun_ = false;
};

}  // namespace riffler::haptics
