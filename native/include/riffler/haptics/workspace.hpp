// From where the hand holds the grip to where the tool shall be, and from the tool's force back to the hand.
#pragma once

#include <cstdint>

#include "riffler/geom/pose.hpp"
#include "riffler/haptics/wrench.hpp"

namespace riffler::haptics {

struct WorkspaceSettings {
  double scale = 1;                 ///< mm of the tool per mm of the grip
  Mat3 turn{1};                     ///< orthonormal, right-handed: the grip's frame → the part's
  std::uint32_t clutch_mask = 2;    ///< buttons of which any lifts the tool off the hand; 0: none does
  std::uint32_t dead_man_mask = 1;  ///< buttons of which any must be held for force; 0: a device that has none

  /// std::invalid_argument naming the field.
  void validate() const;
};

/// The tool's target follows the grip, turned and scaled about a pair of poses that belong together. Whatever is
/// changed makes the last grip and the last target that pair, so the target never jumps: not when the clutch is pressed
/// or let go, not with the scale, not with the view. While the clutch is pressed the target stands still; grip and
/// target then may lie aslant to each other, and turn by the same turns from there on.
class Workspace {
 public:
  /// Validates.
  explicit Workspace(const WorkspaceSettings& settings = {});

  /// The next grip belongs to this target.
  void place(const Pose& target);
  /// std::invalid_argument naming the field; then nothing is changed.
  void set(const WorkspaceSettings& settings);
  const WorkspaceSettings& settings() const { return settings_; }

  /// Of this tick: the target. Of a grip that is not finite or has no axis the last one.
  Pose target(const Pose& grip, std::uint32_t buttons);
  bool dead_man(std::uint32_t buttons) const {
    return settings_.dead_man_mask == 0 || (buttons & settings_.dead_man_mask) != 0;
  }

  /// A twist of the grip in the target's frame: no motion while the clutch is pressed.
  Twist to_target(const Twist& grip) const;
  /// A wrench on the target, on the grip: scaled as the way is, so that what the hand does is what the tool gets. None
  /// while the clutch is pressed.
  Wrench to_grip(const Wrench& target) const;

 private:
  void pair_here();

  WorkspaceSettings settings_;
  Pose grip_, target_;  // of the last tick
  Pose grip_pair_, target_pair_;
  Mat3 aslant_{1};  // from settings_.turn · grip's axis to the target's
  bool clutched_ = false, begun_ = false;
};

}  // namespace riffler::haptics
