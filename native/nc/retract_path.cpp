#include "nc/retract_path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/functions.hpp"

namespace riffler::nc {

namespace {

/// Up to this tilt the tool follows its axis up to safe height: at most twice the height.
constexpr double kSteepEnough = 0.5;  // cos 60°

}  // namespace

ToolEnvelope::ToolEnvelope(const Tool* tool) {
  if (!tool) return;
  length = tool->length(), radius = tool->diameter() / 2;
  for (const auto* pieces : {&tool->shank(), &tool->holder()})
    for (const tool::Frustum& f : *pieces) {
      length = std::max(length, f.z1);
      radius = std::max({radius, f.r0, f.r1});
    }
}

double ToolEnvelope::below_tip(double axis_z) const {
  if (axis_z >= kSteepEnough) return 0;
  return radius * std::sqrt(std::max(0.0, 1 - axis_z * axis_z)) + length * std::max(0.0, -axis_z);
}

Box3 ToolEnvelope::swept_box(const Pose& from, const Pose& to) const {
  Box3 box;
  for (const Pose* pose : {&from, &to}) box.add(pose->tip), box.add(pose->tip + length * pose->axis);
  // No point of the axis is further than length · angle² / 8 from the straight line between its two places.
  const double chord = glm::length(to.axis - from.axis), angle = 2 * base::asin(std::min(1.0, 0.5 * chord));
  return box.grown(radius + length * angle * angle / 8 + 1e-9 * (1 + length));
}

std::vector<Pose> retract_path(const Pose& pose, const ToolEnvelope& reach, const ClearanceZone& space) {
  const Vec3& o = pose.axis;
  const double top = space.top;
  const double up = o.z > 0 ? (top - pose.tip.z) / o.z : std::numeric_limits<double>::infinity();
  if (o.z >= kSteepEnough) return {{pose.tip + up * o, o}};

  const Box3 box = space.box.grown(reach.radius);
  double side = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 2; ++k)
    if (o[k] != 0) side = std::min(side, ((o[k] > 0 ? box.upper[k] : box.lower[k]) - pose.tip[k]) / o[k]);
  if (up <= side && o.z > 0) return {{pose.tip + up * o, o}};

  std::vector<Pose> way;
  const double down = o.z < 0 ? (box.lower.z - pose.tip.z) / o.z : std::numeric_limits<double>::infinity();
  way.push_back({pose.tip + std::min(side, down) * o, o});
  if (down < side) {
    // Out at the bottom: continue below everything to the nearest side, and past it as far as the tool leans back.
    Vec3 p = way.back().tip;
    double best = std::numeric_limits<double>::infinity();
    int axis = 0;
    double to = 0;
    for (int k = 0; k < 2; ++k)
      for (const double out : {-1.0, 1.0}) {
        const double past = reach.length * std::max(0.0, -out * o[k]);
        const double face = (out < 0 ? box.lower[k] : box.upper[k]) + out * past;
        if (std::abs(face - p[k]) < best) best = std::abs(face - p[k]), axis = k, to = face;
      }
    p[axis] = to;
    way.push_back({p, o});
  }
  const Vec3 p = way.back().tip;
  way.push_back({{p.x, p.y, top}, o});
  return way;
}

}  // namespace riffler::nc
