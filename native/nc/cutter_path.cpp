#include "nc/cutter_path.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace riffler {

namespace {

/// Up to this tilt the tool goes along its axis right up to safe height: at most twice the height.
constexpr double kSteepEnough = 0.5;  // cos 60°

/// The cylinder about the axis that holds a tool; nothing is known of an unknown tool.
struct Reach {
  double length = 0, radius = 0;

  explicit Reach(const Tool* tool) {
    if (!tool) return;
    length = tool->length(), radius = tool->diameter() / 2;
    for (const auto* pieces : {&tool->shank(), &tool->holder()})
      for (const Frustum& f : *pieces) {
        length = std::max(length, f.z1);
        radius = std::max({radius, f.r0, f.r1});
      }
  }
};

struct Space {
  Box3 box;    ///< all tips and what is occupied, grown by the clearance
  double top;  ///< z of the tip in rapids from cut to cut
};

/// Where the tip goes from `pose` to safe height with the axis kept: first along the axis out of the space, last the
/// point at safe height.
std::vector<Pose> way_out(const Pose& pose, const Reach& reach, const Space& space) {
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
    // Out at the bottom: on below everything to the nearest side.
    Vec3 p = way.back().tip;
    double best = std::numeric_limits<double>::infinity();
    int axis = 0;
    double to = 0;
    for (int k = 0; k < 2; ++k)
      for (const double face : {box.lower[k], box.upper[k]})
        if (std::abs(face - p[k]) < best) best = std::abs(face - p[k]), axis = k, to = face;
    p[axis] = to;
    way.push_back({p, o});
  }
  const Vec3 p = way.back().tip;
  way.push_back({{p.x, p.y, top}, o});
  return way;
}

const Tool* find(const std::map<int, Tool>& tools, int number) {
  const auto it = tools.find(number);
  return it == tools.end() ? nullptr : &it->second;
}

/// What a tool may hang below its tip while it turns from any end of a cut to any other: nothing where all stand
/// upright, its radius where some are tilted, its length where one points downwards.
double hang(std::span<const CutterPath> paths, const std::map<int, Tool>& tools) {
  bool tilted = false, downwards = false;
  for (const CutterPath& path : paths)
    for (const Pose* end : {&path.poses.front(), &path.poses.back()}) {
      tilted |= end->axis.x != 0 || end->axis.y != 0;
      downwards |= end->axis.z < 0;
    }
  double out = 0;
  for (const CutterPath& path : paths) {
    const Reach reach(find(tools, path.tool));
    out = std::max(out, (tilted || downwards ? reach.radius : 0) + (downwards ? reach.length : 0));
  }
  return out;
}

Space space_of(std::span<const CutterPath> paths, const std::map<int, Tool>& tools, const Clearance& clearance) {
  if (!(std::isfinite(clearance.distance) && clearance.distance > 0))
    throw std::invalid_argument("clearance must be positive and finite");
  Box3 box;
  if (!clearance.occupied.empty()) box.add(clearance.occupied);
  for (const CutterPath& path : paths)
    for (const Pose& pose : path.poses) box.add(pose.tip);
  const double safe = clearance.safe_height.value_or(box.upper.z + clearance.distance);
  if (!box.empty() && !(std::isfinite(safe) && safe > box.upper.z))
    throw std::invalid_argument("safe_height must be above every tip and what is occupied: more than " +
                                std::to_string(box.upper.z) + " mm");
  return {box.grown(clearance.distance), safe + hang(paths, tools)};
}

/// The paths with their axes normalised and one feed per row.
std::vector<CutterPath> checked(std::span<const CutterPath> paths) {
  std::vector<CutterPath> out(paths.begin(), paths.end());
  for (std::size_t k = 0; k < out.size(); ++k) {
    CutterPath& path = out[k];
    const std::string name = "path " + std::to_string(k);
    if (path.poses.empty()) throw std::invalid_argument(name + " has no rows");
    if (path.feed.size() == 1) path.feed.assign(path.poses.size(), path.feed[0]);
    if (path.feed.size() != path.poses.size()) throw std::invalid_argument(name + ": one feed, or one per row");
    for (std::size_t row = 0; row < path.poses.size(); ++row) {
      path.poses[row] = checked_pose(path.poses[row], name, row);
      if (!(std::isfinite(path.feed[row]) && path.feed[row] > 0))
        throw std::invalid_argument(name + ", row " + std::to_string(row) + ": feed must be positive and finite");
    }
  }
  return out;
}

}  // namespace

Program program_from_paths(std::span<const CutterPath> given, std::map<int, Tool> tools, const Clearance& clearance) {
  const std::vector<CutterPath> paths = checked(given);
  const Space space = space_of(paths, tools, clearance);
  Program program;
  for (const CutterPath& path : paths) {
    const Reach reach(find(tools, path.tool));
    const auto rapid = [&](const Pose& pose) { program.append({pose, 0, path.spindle, path.tool, 0, true}); };
    const std::vector<Pose> in = way_out(path.poses.front(), reach, space);
    const std::vector<Pose> out = way_out(path.poses.back(), reach, space);
    std::for_each(in.rbegin(), in.rend(), rapid);
    for (std::size_t row = 0; row < path.poses.size(); ++row)
      program.append({path.poses[row], path.feed[row], path.spindle, path.tool, 0, false});
    std::for_each(out.begin(), out.end(), rapid);
  }
  program.tools = std::move(tools);
  return program;
}

}  // namespace riffler
