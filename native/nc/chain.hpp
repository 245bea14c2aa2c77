// Five-axis machines by the order of their axes: from the part over the table to the bed, and from there over the head
// to the tool.
#pragma once

#include <array>
#include <string>

#include "nc/machine.hpp"
#include "nc/two_rotations.hpp"

namespace riffler {

/// A rotary axis as it stands when all are at 0.
struct RotaryAxis {
  char letter;     ///< A, B or C
  Vec3 direction;  ///< unit, in the machine's coordinates: about it, right-handed, turns what the axis carries
  /// A point on the axis, mm: of a table's in part coordinates, of a head's from the tool's tip.
  Vec3 point{0};
  double low = -1e8, high = 1e8;  ///< deg
};

struct Chain {
  std::string name;
  std::array<RotaryAxis, 2> rotary;  ///< from the part to the tool
  int tables = 2;                    ///< so many of them, the first, carry the part; the others carry the tool
  /// What X Y Z mean: the tip in part coordinates, where the control knows the machine; otherwise where the linear axes
  /// stand, 0 where the tip is in the part's origin with all axes at 0.
  bool tip_words = false;
  std::string offset_code = "G43";  ///< of the tool length
  std::string meaning = {};         ///< for the header
};

class ChainMachine : public Machine {
 public:
  /// std::invalid_argument where directions are no unit vectors, the axes are parallel, or letters or limits are wrong.
  explicit ChainMachine(Chain chain);

  std::string_view axes() const override { return letters_; }
  Pose pose(const Joints& joints) const override;
  int branches() const override { return 2; }
  Joints joints(const Pose& pose, int branch, const Joints& near, double free) const override;
  Vec3 pole() const override { return chain_.rotary[0].direction; }
  bool joint_words() const override { return !chain_.tip_words; }
  std::string offset_block(int number) const override { return chain_.offset_code + " H" + std::to_string(number); }
  std::string meaning() const override { return chain_.meaning; }

 private:
  struct Turns {
    double first, second;  // rad, as the axes turn what they carry
  };
  bool is_table(std::size_t k) const { return static_cast<int>(k) < chain_.tables; }
  Turns turns(const Joints& joints) const;
  Vec3 axis_at(const Turns& turns) const;
  Vec3 tip_in_part(const Vec3& linear, const Turns& turns) const;
  Vec3 linear_at(const Vec3& tip, const Turns& turns) const;
  Vec3 head_offset(const Turns& turns) const;

  Chain chain_;
  TwoRotations two_;
  std::string letters_;
  std::array<std::size_t, 2> index_;  // in Joints
};

}  // namespace riffler
