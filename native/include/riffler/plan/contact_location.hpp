// Cutter contact (CC) to cutter location (CL), for any cutter profile (4.6).
#pragma once

#include <array>

#include "riffler/geom/pose.hpp"
#include "riffler/plan/path.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::plan {

/// Extreme points of the cutter in a given direction: the support function of the profile's convex hull, exact for cuts
/// on convex surfaces. A hollow arc touches a plane only with its ends and is placed accordingly; a ridge that would
/// fit into the hollow is not considered.
class CutterSupport {
 public:
  /// Takes the cutter of `tool`; ignores shank and holder.
  explicit CutterSupport(const Tool& tool);

  /// (radius, height) in mm of the point furthest along `d`, a direction with d.x ≥ 0. On a horizontal edge it is the
  /// outer end, on any other edge the lower end.
  Vec2 point(const Vec2& d) const;
  /// Largest height of the cutter, mm. Shank and holder lie above it.
  double top() const { return top_; }
  /// Radius (mm) of the ball at the tip, centred on the axis; 0 if the tip is not a ball.
  double ball_radius() const { return ball_radius_; }

 private:
  struct Arc {
    Vec2 centre, from, to;
    double radius;
  };
  std::vector<Vec2> corners_;
  std::vector<Arc> arcs_;  // convex arcs only
  double top_, ball_radius_ = 0, size_ = 0;
};

/// Pose of a tool with unit axis `axis` whose cutter touches, from outside, the tangent plane at `contact` (mm, part
/// frame) with unit normal `normal`, out of the material. If axis and normal are parallel the contact could lie
/// anywhere on a circle; it is placed ahead in the feed direction, the limit of leaning forward. This is (4.6) with the
/// sign corrected, for every profile. Throws std::invalid_argument if only the cutter's upper end could touch, because
/// the tool would then stand in the material.
Pose location_of_contact(const CutterSupport& cutter, const Vec3& contact, const Vec3& normal, const Vec3& axis,
                         const Vec3& feed);

/// Pose of the tool at point `k` of a pencil path with unit axis `axis`. A ball tip of the path's radius has its centre
/// on the path. Any other cutter touches the tangent planes of both contacts without entering either; of the possible
/// places it takes the middle between the two contact points in the path's cross-section. Between parallel planes there
/// is no such place, and the cutter touches the first contact's plane only. Other collisions are for cutter_locations
/// to resolve by lifting.
Pose location_on_path(const CutterSupport& cutter, const PencilPath& path, std::size_t k, const Vec3& axis);

}  // namespace riffler::plan
