// How a tool gets into a cut and out of it without meeting part and fixtures.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "nc/retract_path.hpp"
#include "riffler/collide/collider.hpp"
#include "riffler/nc/link_rule.hpp"

namespace riffler::nc {

/// The way from a cut to the clearance plane, the axis kept: the last pose lies in it, the cut's own is left out.
struct Link {
  std::vector<Pose> poses;
  /// As retract_path has it: through what the tool has cut, or a plunge along its axis. Other ways may cross stock.
  bool direct = true;
};

/// Finds links for one tool. Every stretch is checked with cutter, shank and holder by Collider::sweep, that is, not at
/// samples; what is far from part and fixtures by its box alone.
class LinkFinder {
 public:
  /// `rule`, with a collider, and `space` must outlive this.
  LinkFinder(const Tool& tool, const ClearanceZone& space, const LinkRule& rule);

  /// The way out of a cut at `pose`, or into it when it is gone backwards: along the axis up to the clearance plane; or
  /// a stretch along the axis, upwards or between both, one to a side where it takes that, and straight up. The first
  /// that is clear, short ones first. Throws std::invalid_argument saying what is met, where, and what to do.
  Link find(const Pose& pose) const;

 private:
  bool clear(const Pose& from, const Pose& to) const;
  std::optional<Link> from_stretch(const Pose& pose, const Vec3& direction) const;
  std::string met(const std::vector<Pose>& way) const;
  Pose above(const Pose& pose) const;

  const ClearanceZone& space_;
  const LinkRule& rule_;
  collide::Assembly assembly_;
  ToolEnvelope reach_;
  Box3 around_;
};

/// "the holder meets a fixture, 2.39 mm deep, at [1 2 3]", where `pose` is the worst of a motion.
std::string meeting(const collide::Collider& collider, const collide::Assembly& assembly, const Pose& pose);
/// The pose of a motion that is deepest in part and fixtures, by samples: for messages.
Pose deepest_pose(const collide::Collider& collider, const collide::Assembly& assembly, const Motion& motion);

}  // namespace riffler::nc
