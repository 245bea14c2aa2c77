#include "nc/cutter_path.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "nc/way_out.hpp"

namespace riffler {

namespace {

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
