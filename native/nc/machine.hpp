// A machine as NC code sees it: what the axis words of a block mean, in both directions. Reader and writer share it, so
// a new post is one file that implements Machine and one line in machines.cpp.
#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "geom/pose.hpp"
#include "nc/options.hpp"

namespace riffler {

/// The values of the axis words X Y Z A B C of a block: mm and degrees.
using Joints = std::array<double, 6>;

/// Index in Joints of an axis letter X Y Z A B C.
inline std::size_t joint_index(char letter) {
  return static_cast<std::size_t>(letter >= 'X' ? letter - 'X' : letter - 'A' + 3);
}

/// `angle` (deg) by whole turns as near to `near` as it can be.
inline double nearest_turn(double angle, double near) {
  return angle + 360 * std::round((near - angle) / 360);
}

class Machine {
 public:
  virtual ~Machine() = default;

  /// The letters of its axes in the order in which a block names them.
  virtual std::string_view axes() const = 0;
  /// The tool pose, in part coordinates, at these joints.
  virtual Pose pose(const Joints& joints) const = 0;

  /// How many rotary positions hold one axis: 2 where (A, C) and (−A, C + 180°) do; 1 without rotary axes.
  virtual int branches() const = 0;
  /// Joints that hold `pose` on `branch`, each rotary axis by whole turns as near to `near` as it can be. Where the
  /// axis is within `free` (rad) of a pole, the free rotary axis stays at `near` and the axis is held within `free`.
  /// Throws std::invalid_argument saying why where the machine cannot hold the pose.
  virtual Joints joints(const Pose& pose, int branch, const Joints& near, double free) const = 0;
  /// A tool axis (unit vector; its opposite is another) at which a rotary axis is free: the singularity. Zero: none.
  virtual Vec3 pole() const = 0;

  /// Whether the words X Y Z are where linear axes stand, so that the tip's way follows from all axes together: then a
  /// feed along the words means nothing where a rotary axis moves, and such blocks say how long they take (G93).
  virtual bool joint_words() const { return false; }

  /// The block that makes the coordinates mean what pose() says: tool length offset of tool `number`.
  virtual std::string offset_block(int number) const = 0;
  /// One line for the header comment: what the coordinates are.
  virtual std::string meaning() const = 0;
};

struct MachineEntry {
  std::string_view name, description;
  std::unique_ptr<Machine> (*make)(OptionReader& options);
};

/// All machines, in the order in which a list shows them.
std::span<const MachineEntry> machines();

/// Throws std::invalid_argument naming the known ones. Options that the machine does not take stay in `options`.
std::unique_ptr<Machine> make_machine(std::string_view name, OptionReader& options);

// The factories, each in its own file.
std::unique_ptr<Machine> make_tcp(OptionReader& options);
std::unique_ptr<Machine> make_three_axis(OptionReader& options);
std::unique_ptr<Machine> make_linuxcnc_xyzac(OptionReader& options);
std::unique_ptr<Machine> make_linuxcnc_xyzbc(OptionReader& options);

}  // namespace riffler
