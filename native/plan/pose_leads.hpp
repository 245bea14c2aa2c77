// Leads of cuts along poses: how the tool comes down from the level of rapids to a pose, and leaves it.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "riffler/collide/collider.hpp"
#include "riffler/geom/pose.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::plan {

/// Heights are measured along `up`, the set-up's axis.
struct LeadScene {
  const collide::Collider& part;   ///< part and fixtures, or the part alone
  const collide::Collider* stock;  ///< before the operation; null: none is left
  Vec3 up;
  double distance, tolerance;                   ///< of all of the tool from `part`, mm: see CutAlongOptions
  const collide::Collider* fixtures = nullptr;  ///< null: `part` has them, or there are none
  double fixture_distance = 0;                  ///< of all of the tool from `fixtures`, mm
  bool check_stock = true;                      ///< whether shank and holder must stay clear of `stock`
};

/// Pieces of shank and holder as a tool whose tip is the lower end of the lowest piece, and the height of that end;
/// none if there are no pieces.
std::optional<std::pair<Tool, double>> body_of(const Tool& tool);

/// How far (mm) below its tip the lowest point of a tool is that leans by `tilt` (rad) from upright; at least 0.
double depth_below_tip(const Tool& tool, double tilt);

/// A straight lead between a pose and the level of rapids.
struct Lead {
  Vec3 top{0};   ///< tip at the level
  Vec3 near{0};  ///< tip where rapids end: between it and the pose the tool moves at feed
};

/// Finds leads. Queries may run on several threads.
class PoseLeads {
 public:
  /// Keeps references to `tool` and what `scene` refers to.
  PoseLeads(const LeadScene& scene, const Tool& tool);

  /// The lead of a pose to the height `level`, along its axis if nothing obstructs it, else in the first free one of a
  /// few other directions. `in`: the tool comes from above; else it leaves. None if no direction is free: part and
  /// fixtures are bounded along the whole lead, and so is the stock, from shank and holder.
  std::optional<Lead> find(const Pose& pose, double level, bool in) const;

 private:
  std::optional<Lead> along(const Pose& pose, const Vec3& direction, double level, bool in) const;
  double free_of_stock(const Pose& pose, const Vec3& direction, double length) const;

  LeadScene scene_;
  collide::Assembly tool_;
  std::optional<collide::Assembly> body_;
  double body_height_ = 0;
  // Whether the tool, or its shank and holder, are nowhere narrower than below: then they leave along the axis through
  // what they have passed before.
  bool widens_, body_widens_;
};

}  // namespace riffler::plan
