// "tcp": the control knows its own kinematics and keeps the tip on the programmed line (G43.4). Rotary axes A about X,
// then C about Z: the tool axis is O = Rz(C) · Rx(A) · e_z = (sin C sin A, −cos C sin A, cos A), ISO signs.
#include <cmath>
#include <numbers>

#include "nc/machine.hpp"

namespace riffler {

namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr std::size_t kA = 3, kC = 5;

class Tcp final : public Machine {
 public:
  std::string_view axes() const override { return "XYZAC"; }
  int branches() const override { return 2; }
  Vec3 pole() const override { return {0, 0, 1}; }

  Pose pose(const Joints& j) const override {
    const double a = j[kA] * kDegree, c = j[kC] * kDegree;
    return {{j[0], j[1], j[2]}, {std::sin(c) * std::sin(a), -std::cos(c) * std::sin(a), std::cos(a)}};
  }

  Joints joints(const Pose& pose, int branch, const Joints& near, double free) const override {
    const Vec3& o = pose.axis;
    const double side = std::hypot(o.x, o.y);  // sin of the tilt: keeps its digits where acos(o.z) loses them
    double a, c;
    if (std::asin(std::min(1.0, side)) <= free) {
      // C stays; A takes what the axis has in the plane that C gives it.
      c = near[kC];
      a = std::atan2(std::sin(c * kDegree) * o.x - std::cos(c * kDegree) * o.y, o.z) / kDegree;
    } else {
      const double sign = branch == 0 ? 1 : -1;
      a = std::atan2(sign * side, o.z) / kDegree;
      c = nearest_turn(std::atan2(sign * o.x, -sign * o.y) / kDegree, near[kC]);
    }
    return {pose.tip.x, pose.tip.y, pose.tip.z, nearest_turn(a, near[kA]), 0, c};
  }

  std::string offset_block(int number) const override { return "G43.4 H" + std::to_string(number); }
  std::string meaning() const override {
    return "X Y Z: tip in part coordinates under G43.4; A C: tool axis = Rz[C] Rx[A] ez";
  }
};

}  // namespace

std::unique_ptr<Machine> make_tcp(OptionReader&) {
  return std::make_unique<Tcp>();
}

}  // namespace riffler
