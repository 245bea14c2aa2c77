// A machine as NC code sees it: the meaning of a block's axis words, in both directions. Used by reader and writer. The
// description lists the axes in order, from the part over the tables to the bed, and from there over the heads to the
// tool; description.hpp reads it from a file.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "nc/machine/two_rotations.hpp"
#include "riffler/geom/pose.hpp"

namespace riffler::nc {

/// Values of the axis words X Y Z A B C of a block: mm and degrees.
using Joints = std::array<double, 6>;

/// Index in Joints of an axis letter X Y Z A B C, and the inverse.
inline std::size_t joint_index(char letter) {
  return static_cast<std::size_t>(letter >= 'X' ? letter - 'X' : letter - 'A' + 3);
}
inline constexpr std::string_view kJointLetters = "XYZABC";

/// `angle` (deg) plus the whole turns that bring it nearest to `near`.
inline double nearest_turn(double angle, double near) {
  return angle + 360 * std::round((near - angle) / 360);
}

/// Limits and rate of an axis; `rate`: mm/min or deg/min. A machine rounds limits inwards to printable numbers.
struct AxisRange {
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  double rate = std::numeric_limits<double>::infinity();

  bool limited() const { return std::isfinite(low) || std::isfinite(high); }
};

/// A rotary axis in the position with all axes at 0.
struct RotaryAxis {
  char letter;     ///< A, B or C
  Vec3 direction;  ///< unit, machine coordinates: the axis turns what it carries about this, right-handed
  /// A point on the axis, mm: for a table in part coordinates, for a head relative to the tool's tip.
  Vec3 point{0};
  bool carries_part = true;
};

/// The control that reads the code.
struct Control {
  std::string language = "rs274";   ///< one of kLanguages in nc/machine/post_options.hpp
  std::string tool_length = "G43";  ///< block that activates tool length compensation
  std::string note;                 ///< for the header: required settings of the control
  /// Motion of rapids: "straight"; "independent", each axis at its own rate until it arrives; or "unknown".
  std::string rapids = "unknown";
  bool inverse_time = false;            ///< G93 for blocks that move a rotary axis; otherwise always G94
  std::vector<std::string> start, end;  ///< the machine's own first and last blocks, verbatim
  /// Blocks that retract the tool clear of everything on the table: before the first move, before tool changes and at
  /// the end.
  std::vector<std::string> retract;
  std::string coolant = "off";  ///< default: "flood", "mist", "off"
};

struct MachineDescription {
  std::string name;
  /// None, one or two rotary axes, from the part to the tool: tables first.
  std::vector<RotaryAxis> rotary;
  std::array<AxisRange, 6> ranges;  ///< indexed by joint_index
  /// The meaning of X Y Z. True: the tip in part coordinates, if the control knows the machine. False: the positions of
  /// the linear axes, 0 when the tip is at the part's origin with all axes at 0.
  bool tip_words = true;
  Control control;
};

class Machine {
 public:
  /// Throws std::invalid_argument for directions that are no unit vectors, parallel axes, and wrong letters or limits.
  explicit Machine(MachineDescription description);

  const std::string& name() const { return description_.name; }
  const Control& control() const { return description_.control; }
  /// The letters of its axes in the order in which a block names them.
  std::string_view axes() const { return letters_; }
  const AxisRange& range(std::size_t joint) const { return description_.ranges[joint]; }

  /// The tool pose in part coordinates at these joints.
  Pose pose(const Joints& joints) const;

  /// Number of rotary positions for one tool axis: 2 if (A, C) and (−A, C + 180°) give the same, otherwise 1.
  int branches() const { return description_.rotary.size() == 2 ? 2 : 1; }
  /// Joints for `pose` on `branch`, each rotary axis within half a turn of `near`; ignores limits. If the axis is
  /// within `free` (rad) of a pole, the free rotary axis stays at `near` and the axis is matched within 2 `free`.
  /// Throws std::invalid_argument with the reason if no angles of the rotary axes give this axis.
  Joints joints(const Pose& pose, int branch, const Joints& near, double free) const;
  /// Keeps the rotary axes and sets the linear ones so that the tip is at `tip` (mm, part coordinates).
  Joints with_tip(const Joints& joints, const Vec3& tip) const;
  /// The tool axis (unit vector; also its opposite) at which a rotary axis is free: the singularity. Zero: none.
  Vec3 pole() const;
  /// Index of the rotary axis that is free at the pole; only if there is a pole.
  std::size_t free_joint() const { return index_.front(); }

  /// Whether X Y Z are positions of linear axes, so that the tip's path follows from all axes together. A feed along
  /// the words is then meaningless while a rotary axis moves, and such blocks state their duration (G93).
  bool joint_words() const { return !description_.tip_words; }
  /// Joints subject to limits: rotary axes, and linear axes if their words are axis positions.
  const std::vector<std::size_t>& limited() const { return limited_; }
  /// The first of limited() that exceeds its limits by more than `slack` (mm, deg), or 6.
  std::size_t beyond(const Joints& joints, double slack) const;

  /// One line for the header comment: the meaning of the coordinates.
  std::string meaning() const;

 private:
  using Turns = std::array<double, 2>;  // rad, in the direction of the axes' own rotation
  Turns turns(const Joints& joints) const;
  Vec3 axis_at(const Turns& turns) const;
  Vec3 head_offset(const Turns& turns) const;
  Vec3 tip_in_part(const Vec3& linear, const Turns& turns) const;
  Vec3 linear_at(const Vec3& tip, const Turns& turns) const;
  Turns angles(const Vec3& axis, int branch, const Turns& near, double free) const;
  [[noreturn]] void cannot_reach() const;

  MachineDescription description_;
  std::string letters_;
  std::vector<std::size_t> index_;  // index in Joints per rotary axis
  std::vector<std::size_t> limited_;
  std::vector<Vec3> seen_;  // directions about which the tool turns, seen from the part
  TwoRotations two_{};
};

}  // namespace riffler::nc
