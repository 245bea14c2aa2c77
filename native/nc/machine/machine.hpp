// A machine as NC code sees it: what the axis words of a block mean, in both directions. Reader and writers share it.
// It is described by its axes in their order, from the part over the tables to the bed and from there over the heads to
// the tool; description.hpp makes it from a file.
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

/// The values of the axis words X Y Z A B C of a block: mm and degrees.
using Joints = std::array<double, 6>;

/// Index in Joints of an axis letter X Y Z A B C, and the letter of an index.
inline std::size_t joint_index(char letter) {
  return static_cast<std::size_t>(letter >= 'X' ? letter - 'X' : letter - 'A' + 3);
}
inline constexpr std::string_view kJointLetters = "XYZABC";

/// `angle` (deg) by whole turns as near to `near` as it can be.
inline double nearest_turn(double angle, double near) {
  return angle + 360 * std::round((near - angle) / 360);
}

/// What an axis can do. `rate`: mm/min or deg/min. A machine takes limits inwards to numbers that can be printed.
struct AxisRange {
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  double rate = std::numeric_limits<double>::infinity();

  bool limited() const { return std::isfinite(low) || std::isfinite(high); }
};

/// A rotary axis as it stands when all are at 0.
struct RotaryAxis {
  char letter;     ///< A, B or C
  Vec3 direction;  ///< unit, in the machine's coordinates: about it, right-handed, turns what the axis carries
  /// A point on the axis, mm: of a table's in part coordinates, of a head's from the tool's tip.
  Vec3 point{0};
  bool carries_part = true;
};

/// What reads the code.
struct Control {
  std::string language = "rs274";   ///< one of kLanguages in nc/machine/post_options.hpp
  std::string tool_length = "G43";  ///< block that makes the tool's length count
  std::string note;                 ///< for the header: how the control must be set
  /// How rapids go: "straight"; "independent", each axis at its own rate until it is there; or "unknown".
  std::string rapids = "unknown";
  bool inverse_time = false;            ///< G93 for blocks in which a rotary axis moves; otherwise always G94
  std::vector<std::string> start, end;  ///< blocks of the machine's own before and after everything, verbatim
  /// Blocks that take the tool out of everything's way, whatever stands on the table: before the first move, tool
  /// changes and the end.
  std::vector<std::string> retract;
  std::string coolant = "off";  ///< where its user says nothing: "flood", "mist", "off"
};

struct MachineDescription {
  std::string name;
  /// None, one or two, from the part to the tool: tables first.
  std::vector<RotaryAxis> rotary;
  std::array<AxisRange, 6> ranges;  ///< by joint_index
  /// What X Y Z mean: the tip in part coordinates, where the control knows the machine; otherwise where the linear axes
  /// stand, 0 where the tip is in the part's origin with all axes at 0.
  bool tip_words = true;
  Control control;
};

class Machine {
 public:
  /// std::invalid_argument where directions are no unit vectors, the axes are parallel, or letters or limits are wrong.
  explicit Machine(MachineDescription description);

  const std::string& name() const { return description_.name; }
  const Control& control() const { return description_.control; }
  /// The letters of its axes in the order in which a block names them.
  std::string_view axes() const { return letters_; }
  const AxisRange& range(std::size_t joint) const { return description_.ranges[joint]; }

  /// The tool pose, in part coordinates, at these joints.
  Pose pose(const Joints& joints) const;

  /// How many rotary positions hold one axis: 2 where (A, C) and (−A, C + 180°) do, otherwise 1.
  int branches() const { return description_.rotary.size() == 2 ? 2 : 1; }
  /// Joints that hold `pose` on `branch`, each rotary axis by whole turns as near to `near` as it can be; limits do not
  /// count here. Where the axis is within `free` (rad) of a pole, the free rotary axis stays at `near` and the axis is
  /// held within 2 `free`. Throws std::invalid_argument saying why where the rotary axes cannot hold it at any angle.
  Joints joints(const Pose& pose, int branch, const Joints& near, double free) const;
  /// The rotary axes as they are, the linear ones where they put the tip at `tip` (part coordinates).
  Joints with_tip(const Joints& joints, const Vec3& tip) const;
  /// A tool axis (unit vector; its opposite is another) at which a rotary axis is free: the singularity. Zero: none.
  Vec3 pole() const;
  /// Of the rotary axis that is free there; only where there is a pole.
  std::size_t free_joint() const { return index_.front(); }

  /// Whether the words X Y Z are where linear axes stand, so that the tip's way follows from all axes together: then a
  /// feed along the words means nothing where a rotary axis moves, and such blocks say how long they take (G93).
  bool joint_words() const { return !description_.tip_words; }
  /// Joints that limits bind: rotary axes, and linear ones where their words are where they stand.
  const std::vector<std::size_t>& limited() const { return limited_; }
  /// Of limited() the first one that is beyond its limits by more than `slack` (mm, deg), or 6.
  std::size_t beyond(const Joints& joints, double slack) const;

  /// One line for the header comment: what the coordinates are.
  std::string meaning() const;

 private:
  using Turns = std::array<double, 2>;  // rad, as the axes turn what they carry
  Turns turns(const Joints& joints) const;
  Vec3 axis_at(const Turns& turns) const;
  Vec3 head_offset(const Turns& turns) const;
  Vec3 tip_in_part(const Vec3& linear, const Turns& turns) const;
  Vec3 linear_at(const Vec3& tip, const Turns& turns) const;
  Turns angles(const Vec3& axis, int branch, const Turns& near, double free) const;
  [[noreturn]] void cannot_reach() const;

  MachineDescription description_;
  std::string letters_;
  std::vector<std::size_t> index_;  // in Joints, of each rotary axis
  std::vector<std::size_t> limited_;
  std::vector<Vec3> seen_;  // directions about which the tool turns, seen from the part
  TwoRotations two_{};
};

}  // namespace riffler::nc
