#include "riffler/nc/cutter_path.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "nc/links.hpp"
#include "nc/retract_path.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::nc {

namespace {

const Tool* find(const std::map<int, Tool>& tools, int number) {
  const auto it = tools.find(number);
  return it == tools.end() ? nullptr : &it->second;
}

/// How far (mm) a tool may extend below its tip while it turns between any two ends of cuts: 0 if all axes are
/// vertical, its radius if some are tilted, its length if one points down.
double hang(std::span<const CutterPath> paths, const std::map<int, Tool>& tools) {
  bool tilted = false, downwards = false;
  for (const CutterPath& path : paths)
    for (const Pose* end : {&path.poses.front(), &path.poses.back()}) {
      tilted |= end->axis.x != 0 || end->axis.y != 0;
      downwards |= end->axis.z < 0;
    }
  double out = 0;
  for (const CutterPath& path : paths) {
    const ToolEnvelope reach(find(tools, path.tool));
    out = std::max(out, (tilted || downwards ? reach.radius : 0) + (downwards ? reach.length : 0));
  }
  return out;
}

ClearanceZone space_of(std::span<const CutterPath> paths, const std::map<int, Tool>& tools,
                       const Clearance& clearance) {
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

/// The paths with normalised axes and one feed per row.
std::vector<CutterPath> checked(std::span<const CutterPath> paths) {
  std::vector<CutterPath> out(paths.begin(), paths.end());
  for (std::size_t k = 0; k < out.size(); ++k) {
    CutterPath& path = out[k];
    const std::string name = "path " + std::to_string(k);
    if (path.poses.empty()) throw std::invalid_argument(name + " has no rows");
    // A copy: assign may not read from the vector that it replaces.
    if (path.feed.size() == 1) path.feed.assign(path.poses.size(), double{path.feed[0]});
    if (path.feed.size() != path.poses.size()) throw std::invalid_argument(name + ": one feed, or one per row");
    for (std::size_t row = 0; row < path.poses.size(); ++row) {
      path.poses[row] = checked_pose(path.poses[row], name, row);
      if (!(std::isfinite(path.feed[row]) && path.feed[row] > 0))
        throw std::invalid_argument(name + ", row " + std::to_string(row) + ": feed must be positive and finite");
    }
  }
  return out;
}

/// Approach and retract of a path.
struct Ends {
  Link in, out;
};

/// With a collider, found in parallel; throws for the first path that has none.
std::vector<Ends> ends_of(std::span<const CutterPath> paths, const std::map<int, Tool>& tools,
                          const ClearanceZone& space, const LinkRule& rule) {
  std::vector<Ends> out(paths.size());
  std::map<int, LinkFinder> finders;
  for (std::size_t k = 0; k < paths.size() && rule.collider; ++k) {
    const Tool* tool = find(tools, paths[k].tool);
    if (!tool)
      throw std::invalid_argument("path " + std::to_string(k) +
                                  ": links are checked with the tool's shape, and that of tool " +
                                  std::to_string(paths[k].tool) + " is not known: give tools");
    finders.try_emplace(paths[k].tool, *tool, space, rule);
  }
  std::vector<std::string> faults(2 * paths.size());
  base::parallel_for(faults.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const CutterPath& path = paths[i / 2];
      const Pose& pose = i % 2 ? path.poses.back() : path.poses.front();
      Link& link = i % 2 ? out[i / 2].out : out[i / 2].in;
      try {
        if (rule.collider)
          link = finders.at(path.tool).find(pose);
        else
          link.poses = retract_path(pose, ToolEnvelope(find(tools, path.tool)), space);
      } catch (const std::invalid_argument& e) {
        faults[i] = e.what();
      }
    }
  });
  for (std::size_t i = 0; i < faults.size(); ++i)
    if (!faults[i].empty())
      throw RowError("path " + std::to_string(i / 2), i % 2 ? paths[i / 2].poses.size() - 1 : 0,
                     (i % 2 ? "no retract is clear: " : "no approach is clear: ") + faults[i]);
  return out;
}

/// One move of a link: its end pose, and whether it is at feed.
struct LinkMove {
  Pose to;
  bool fed;
};

/// The moves along a link, out of the cut at `cut`. In reverse they are the approach, whose last move, into the cut, is
/// the path's first row. `level`: z (mm) below which there may be stock.
std::vector<LinkMove> moves_of(const Link& link, const Pose& cut, double level, const std::optional<double>& lead_in,
                               bool approach) {
  std::vector<LinkMove> out;
  double way = 0;
  Pose from = cut;
  for (const Pose& to : link.poses) {
    const double length = glm::length(to.tip - from.tip);
    if (lead_in && approach && way < *lead_in && *lead_in < way + length)
      out.push_back({{from.tip + (*lead_in - way) / length * (to.tip - from.tip), to.axis}, true});
    const bool fed = lead_in ? approach && way + length <= *lead_in : !link.direct;
    // A vertical rise ends in the air above everything: no feed move ends in the clearance plane.
    const bool rises = !link.direct && &to == &link.poses.back() && !lead_in;
    if (rises && from.tip.z < level && level < to.tip.z) out.push_back({{{to.tip.x, to.tip.y, level}, to.axis}, true});
    out.push_back({to, fed && !rises});
    way += length, from = to;
  }
  return out;
}

}  // namespace

Program program_from_paths(std::span<const CutterPath> given, std::map<int, Tool> tools, const Clearance& clearance,
                           const LinkRule& links) {
  const std::vector<CutterPath> paths = checked(given);
  validate(links);
  Clearance room = clearance;
  if (links.collider) room.occupied.add(links.collider->bounds());
  const ClearanceZone space = space_of(paths, tools, room);
  const double level = space.box.upper.z - clearance.distance;
  const std::vector<Ends> ends = ends_of(paths, tools, space, links);
  Program program;
  for (std::size_t k = 0; k < paths.size(); ++k) {
    const CutterPath& path = paths[k];
    const auto link = [&](const Pose& to, bool fed, double feed) {
      program.append({to, fed ? feed : 0, path.spindle, path.tool, 0, !fed});
    };
    const auto in = moves_of(ends[k].in, path.poses.front(), level, links.lead_in, true),
               out = moves_of(ends[k].out, path.poses.back(), level, links.lead_in, false);
    // In reverse, a move ends where its predecessor, seen from the cut, ends.
    for (std::size_t i = in.size(); i-- > 0;) link(in[i].to, i + 1 < in.size() && in[i + 1].fed, path.feed.front());
    for (std::size_t row = 0; row < path.poses.size(); ++row)
      program.append({path.poses[row], path.feed[row], path.spindle, path.tool, 0, false});
    for (const LinkMove& move : out) link(move.to, move.fed, path.feed.back());
  }
  program.tools = std::move(tools);
  return program;
}

}  // namespace riffler::nc
