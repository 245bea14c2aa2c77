// Links: collision-free paths of a tool into a cut and out of it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "nc/retract_path.hpp"
#include "riffler/collide/collider.hpp"
#include "riffler/nc/link_rule.hpp"

namespace riffler::nc {

/// Path from a cut to the clearance plane with a constant axis. The last pose lies in the plane; the cut's own pose is
/// left out.
struct Link {
  std::vector<Pose> poses;
  /// Whether the path is that of retract_path: through space that the tool has cut, or a plunge along its axis. Other
  /// paths may cross stock.
  bool direct = true;
};

/// Finds links for one tool. Collider::sweep checks every move with cutter, shank and holder continuously, without
/// sampling; moves far from part and fixtures pass by their boxes alone.
class LinkFinder {
 public:
  /// `rule` (with a collider) and `space` must outlive this object.
  LinkFinder(const Tool& tool, const ClearanceZone& space, const LinkRule& rule);

  /// Path out of a cut at `pose`, or in reverse into it: along the axis up to the clearance plane; otherwise a move
  /// along the axis, upwards or in between, then sideways if needed, then straight up. Returns the first clear one,
  /// trying short ones first. Throws std::invalid_argument saying what collides, where, and what to do.
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

/// Text such as "the holder meets a fixture, 2.39 mm deep, at [1 2 3]" for the worst pose of a motion.
std::string meeting(const collide::Collider& collider, const collide::Assembly& assembly, const Pose& pose);
/// The sampled pose of a motion that is deepest in part and fixtures, for messages.
Pose deepest_pose(const collide::Collider& collider, const collide::Assembly& assembly, const Motion& motion);

}  // namespace riffler::nc
