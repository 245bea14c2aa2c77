// The independent reference for carving: the least signed distance of a point from a moving cutter, with a bound on how
// far from the least it may be. It shares nothing with the engine but what it is asked about, the profile and the
// motion: no pieces, no steps, no intersections with rays.
#pragma once

#include <limits>
#include <memory>
#include <utility>

#include "reference/cutter_distance.hpp"
#include "riffler/geom/pose.hpp"

namespace riffler::reference {

/// The least signed distance over the motion lies in it.
struct Bracket {
  double lower, upper;
  int poses;  ///< at which the distance was evaluated
};

/// Global minimum over t by branch and bound. Over an interval of half-width h about t, with f the distance at t,
/// L a bound on the speed at which the point moves in the tool's frame, A one on its acceleration there, and a ball of
/// radius ρ that touches the cutter from outside where it is nearest, the distance is at least both
///
///   f − L h   and   f − |f′| h − (A + L² / (ρ − f)) h² / 2,
///
/// the second since the cutter lies outside of that ball, so the distance from all that is outside of it bounds the
/// cutter's from below. Unlike samples, however dense, this cannot pass over a minimum.
class SweptDistance {
 public:
  SweptDistance(const tool::Profile& profile, const Motion& motion)
      : SweptDistance(std::make_shared<const CutterDistance>(profile), motion) {}
  /// Many moves of one cutter share it.
  SweptDistance(std::shared_ptr<const CutterDistance> cutter, const Motion& motion)
      : cutter_(std::move(cutter)), motion_(motion) {}

  /// Until the bracket is no wider than `gap`, or all of it lies below `below` or above `above`. (Not narrower than
  /// rounding, some 1e-15 of the sizes.)
  Bracket bracket(const Vec3& p, double gap, double below, double above) const;
  Bracket bracket(const Vec3& p, double gap, double enough = std::numeric_limits<double>::infinity()) const {
    return bracket(p, gap, -enough, enough);
  }

  /// Positive outside of the swept volume, and then the distance from it; negative inside: no deeper than the point's
  /// depth in the swept volume, and as deep as it ever was in the tool. Within 1e-9 mm.
  double operator()(const Vec3& p) const { return bracket(p, 1e-9).upper; }

  /// No more than the least distance, from one pose: for telling what is far.
  double lower_bound(const Vec3& p) const;

 private:
  struct Place {  // of the point in the tool's frame
    Vec3 from_tip, axis, radial;
    double rho, z;
  };
  struct Node {
    double t, half, lower;
    bool operator<(const Node& o) const { return lower > o.lower; }  // the least lower bound is looked at first
  };
  struct Approach;
  Place place(const Vec3& from_start, double t) const;
  double by_slices(const Approach& approach, const Place& place, double best) const;
  Node node(const Vec3& from_start, double t, double half, double above, double& best) const;

  std::shared_ptr<const CutterDistance> cutter_;
  Motion motion_;
};

}  // namespace riffler::reference
