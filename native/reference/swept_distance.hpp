// The independent reference for carving: the least signed distance of a point from a moving cutter, with a bound on how
// far from the least it may be. It shares nothing with the engine but what it is asked about, the profile and the
// motion: no pieces, no steps, no intersections with rays.
#pragma once

#include <limits>

#include "geom/pose.hpp"
#include "reference/cutter_distance.hpp"

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
  SweptDistance(const Profile& profile, const Motion& motion) : cutter_(profile), motion_(motion) {}

  /// Until the bracket is no wider than `gap`, or all of it lies below −`enough` or above `enough`. (Not narrower than
  /// rounding, some 1e-15 of the sizes.)
  Bracket bracket(const Vec3& p, double gap, double enough = std::numeric_limits<double>::infinity()) const;

  /// Positive outside of the swept volume, and then the distance from it; negative inside: no deeper than the point's
  /// depth in the swept volume, and as deep as it ever was in the tool. Within 1e-9 mm.
  double operator()(const Vec3& p) const { return bracket(p, 1e-9).upper; }

 private:
  struct Node {
    double t, half, lower;
    bool operator<(const Node& o) const { return lower > o.lower; }  // the least lower bound is looked at first
  };
  struct Approach;
  double by_slices(const Approach& approach, double rho, double z, double best) const;
  Node node(const Vec3& from_start, double t, double half, double& best) const;

  CutterDistance cutter_;
  Motion motion_;
};

}  // namespace riffler::reference
