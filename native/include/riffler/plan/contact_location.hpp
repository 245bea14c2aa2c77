// Cutter contact (CC) to cutter location (CL), for any profile (4.6).
#pragma once

#include <array>

#include "riffler/geom/pose.hpp"
#include "riffler/plan/path.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::plan {

/// The cutter's extreme points in a direction: convex, so exact for what is milled from outside. It is the support of
/// the profile's convex hull: a hollow arc touches a plane with its ends only, and so it is placed; that the hollow
/// itself could fit round a ridge is not looked for.
class CutterSupport {
 public:
  explicit CutterSupport(const Tool& tool);

  /// (radius, height) of the point furthest along `d`, a direction of the half-plane with d.x ≥ 0. Of a level edge that
  /// is as far everywhere its outer end, of any other edge its lower one.
  Vec2 point(const Vec2& d) const;
  /// Largest height of the cutter; above it are shank and holder.
  double top() const { return top_; }
  /// Radius of the tip's ball, centred on the axis; 0 where the tip is no ball.
  double ball_radius() const { return ball_radius_; }

 private:
  struct Arc {
    Vec2 centre, from, to;
    double radius;
  };
  std::vector<Vec2> corners_;
  std::vector<Arc> arcs_;  // those that bulge
  double top_, ball_radius_ = 0, size_ = 0;
};

/// Where the tool stands with `axis` when its cutter touches the tangent plane at `contact`, whose normal `normal`
/// points out of the material, from outside. Axis and normal are unit vectors. Where they are parallel the place on the
/// contact circle is free: it lies ahead in the feed direction (the limit of leaning forward). This is (4.6) with its
/// sign put right, for every profile. std::invalid_argument where only the cutter's upper end could touch: the tool
/// would stand in the material.
Pose location_of_contact(const CutterSupport& cutter, const Vec3& contact, const Vec3& normal, const Vec3& axis,
                         const Vec3& feed);

/// Where the tool stands at point `k` of a pencil path with `axis`. A tip ball of the path's radius: its centre on the
/// path. Any other cutter touches the tangent planes of both contacts without entering either, the middle between its
/// two contact points in the path's cross-section; where the planes are parallel there is no such place, and it touches
/// the first contact's only. What else it meets is for cutter_locations to lift it out of.
Pose location_on_path(const CutterSupport& cutter, const PencilPath& path, std::size_t k, const Vec3& axis);

}  // namespace riffler::plan
