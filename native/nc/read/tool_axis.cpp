#include "nc/read/tool_axis.hpp"

#include <cmath>
#include <optional>

namespace riffler::nc {

Joints joints_holding(const Machine& machine, const Vec3& axis, const Joints& near, double free) {
  constexpr double kBeyond = 1e9;  // larger than any distance
  std::optional<Joints> best;
  double best_way = 0;
  for (int branch = 0; branch < machine.branches(); ++branch) {
    const Joints joints = machine.joints({Vec3(0), axis}, branch, near, free);
    double way = machine.beyond(joints, 1e-6) < joints.size() ? kBeyond : 0;
    for (std::size_t k = 3; k < joints.size(); ++k) way += std::abs(joints[k] - near[k]);
    if (!best || way < best_way) best = joints, best_way = way;
  }
  return *best;
}

bool is_whole_turn(double degrees) {
  constexpr double kSameAngle = 0.06;  // deg
  return std::abs(nearest_turn(degrees, 0)) < kSameAngle;
}

}  // namespace riffler::nc
