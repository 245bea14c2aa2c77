// "3-axis": no rotary axes, the tool stands upright.
#include <cmath>
#include <stdexcept>

#include "nc/machine.hpp"

namespace riffler {

namespace {

class ThreeAxis final : public Machine {
 public:
  std::string_view axes() const override { return "XYZ"; }
  int branches() const override { return 1; }
  Vec3 pole() const override { return {0, 0, 0}; }

  Pose pose(const Joints& j) const override { return {{j[0], j[1], j[2]}, {0, 0, 1}}; }

  Joints joints(const Pose& pose, int, const Joints&, double) const override {
    // 1e-6 is what an axis keeps that went through single precision.
    if (!(pose.axis.z > 0 && std::hypot(pose.axis.x, pose.axis.y) <= 1e-6))
      throw std::invalid_argument("the axis is not (0, 0, 1), and post 3-axis has no rotary axes");
    return {pose.tip.x, pose.tip.y, pose.tip.z, 0, 0, 0};
  }

  std::string offset_block(int number) const override { return "G43 H" + std::to_string(number); }
  std::string meaning() const override { return "X Y Z: tip in part coordinates; the tool stands upright"; }
};

}  // namespace

std::unique_ptr<Machine> make_three_axis(OptionReader&) {
  return std::make_unique<ThreeAxis>();
}

}  // namespace riffler
