// The independent reference for carving: the smallest signed distance of a point from a moving cutter, with a bound on
// its error. It shares only its input with the engine, the profile and the motion: no pieces, no steps, no
// intersections with rays.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "reference/convex_search.hpp"
#include "reference/cutter_distance.hpp"
#include "riffler/geom/pose.hpp"

namespace riffler::reference {

/// Global minimum over t by branch and bound. Over an interval of half-width h about t, with f the distance at t,
/// L a bound on the speed at which the point moves in the tool's frame, A one on its acceleration there, and a ball of
/// radius ρ that touches the cutter from outside where it is nearest, the distance is at least both
///
///   f − L h   and   f − |f′| h − (A + L² / (ρ − f)) h² / 2,
///
/// the second because the cutter is outside that ball, so the distance from the ball's outside bounds the
/// cutter's distance from below. Unlike dense samples, this cannot miss a minimum.
///
/// On a straight move the distance from a convex cutter is a convex function of t, and two tangents give the bound
/// (convex_search.hpp): 4 poses on average in the stress run. The same holds outside of a cutter of convex slices, for
/// each slice.
class SweptDistance {
 public:
  SweptDistance(const tool::Profile& profile, const Motion& motion)
      : SweptDistance(std::make_shared<const CutterDistance>(profile), motion) {}
  /// Many moves can share one cutter.
  SweptDistance(std::shared_ptr<const CutterDistance> cutter, const Motion& motion)
      : cutter_(std::move(cutter)), motion_(motion) {}

  /// Refines the bracket until it is at most `gap` wide, or entirely below `below` or above `above`. (It cannot become
  /// narrower than rounding, about 1e-15 of the sizes.)
  Bracket bracket(const Vec3& p, double gap, double below, double above) const;
  Bracket bracket(const Vec3& p, double gap, double enough = std::numeric_limits<double>::infinity()) const {
    return bracket(p, gap, -enough, enough);
  }

  /// Outside the swept volume the distance from it. Inside negative: the largest depth of the point in the tool during
  /// the motion, which is at most its depth in the swept volume. Accurate to 1e-9 mm.
  double operator()(const Vec3& p) const { return bracket(p, 1e-9).upper; }

  /// A lower bound on the smallest distance, from one pose: a fast test for far points.
  double lower_bound(const Vec3& p) const;

 private:
  struct Place {  // of the point in the tool's frame
    Vec3 from_tip, axis, radial;
    double rho, z;
  };
  struct Node {
    double t, half, lower;
    bool operator<(const Node& o) const { return lower > o.lower; }  // examine the smallest lower bound first
  };
  struct Approach;
  Place place(const Vec3& from_start, double t) const;
  double by_slices(const Approach& approach, const Place& place, double best) const;
  std::optional<Bracket> by_tangents(const Vec3& from_start, double gap, double below, double above) const;
  Node node(const Vec3& from_start, double t, double half, double above, double& best) const;

  std::shared_ptr<const CutterDistance> cutter_;
  Motion motion_;
};

}  // namespace riffler::reference
