// A curve on the sphere through given axes, with a continuous derivative.
#pragma once

#include <vector>

#include "riffler/geom/vec.hpp"

namespace riffler::plan {

/// Between keys (s_k, a_k), s ascending, the curve blends two great circles: P leaves a_k with the key's velocity w_k,
/// Q arrives at a_(k+1) with its velocity. The axis is slerp(P, Q, 3u² − 2u³), where u is the fraction of the span:
/// circular blending after Kim and Nam (Computer-Aided Design 27 (1995) 385) with great circles. The slope of the
/// weight vanishes at both ends, so position and velocity there are those of P and Q, and the derivative is continuous
/// at keys.
///
/// Velocities: the direction bisects the great circles before and after the key; the length is the smaller of their two
/// rates times the cosine of half the angle between them (0 where they reverse). 0 at the ends of an open curve, which
/// is constant outside. Evenly spaced keys on one great circle are therefore passed at its constant rate, as by slerp.
///
/// Rate: with Ω the angle of a span and L its length, P and Q are at most θ ≤ (π + Ω) / 2 apart, never opposite, since
/// velocities are capped at (π − Ω) / 2L. So |da/ds| ≤ max |w| / cos(θ/2) + 1.5 θ / L is finite. Measured over random
/// keys with spans up to 3.1 rad, it stays below 1.7 Ω / L, that is 1.7 times the rate of slerp in the same span; any
/// cubic curve that starts and ends at rest needs 1.5.
class SmoothAxes {
 public:
  /// Neighbouring axes must not be opposite, `places` strictly ascending. `period` > 0: a closed curve of that length.
  SmoothAxes(std::vector<double> places, std::vector<Vec3> axes, double period = 0);

  /// The axis at s. A closed curve repeats; an open one is constant outside.
  Vec3 at(double s) const;

 private:
  double angle_of(std::size_t span) const;

  std::vector<double> places_;  // a closed curve repeats its first key at the end
  std::vector<Vec3> axes_, velocities_;
  double period_;
};

/// The axis after `u` on the great circle from `a` with velocity `v` (orthogonal to a, rad per unit).
Vec3 along_great_circle(const Vec3& a, const Vec3& v, double u);
/// The velocity that leads from `a` to `b` in one unit.
Vec3 velocity_between(const Vec3& a, const Vec3& b);

}  // namespace riffler::plan
