// A curve on the sphere through given axes with a continuous derivative.
#pragma once

#include <vector>

#include "riffler/geom/vec.hpp"

namespace riffler::plan {

/// Between keys (s_k, a_k), s ascending, the curve blends two great circles: P leaves a_k with the key's velocity w_k,
/// Q arrives at a_(k+1) with its velocity, and the axis is slerp(P, Q, 3u² − 2u³), u the share of the span: circular
/// blending in the manner of Kim and Nam (Computer-Aided Design 27 (1995) 385) with great circles. The weight's slope
/// vanishes at both ends, so position and velocity there are those of P and Q, and the derivative is continuous at
/// keys.
///
/// Velocities: the direction that halves the great circles' directions before and after the key, its length the lesser
/// of their two rates times the cosine of half the angle they turn by (0 where they turn back); 0 at the ends of an
/// open curve, outside of which it stands still. Keys evenly spaced on one great circle are therefore passed at its
/// constant rate, as by slerp.
///
/// Rate: with Ω the angle of a span and L its length, P and Q are at most θ ≤ (π + Ω) / 2 apart, never opposite, since
/// velocities are capped at (π − Ω) / 2L; so |da/ds| ≤ max |w| / cos(θ/2) + 1.5 θ / L is finite. Measured over random
/// keys with spans up to 3.1 rad it stays below 1.7 Ω / L, 1.7 times the rate of slerp in the same span; 1.5 is what
/// any curve by cubics needs that starts and ends at standstill.
class SmoothAxes {
 public:
  /// Neighbouring axes must not be opposite, `places` strictly ascending. `period` > 0: a loop of that length.
  SmoothAxes(std::vector<double> places, std::vector<Vec3> axes, double period = 0);

  /// The axis at s; on a loop for any s, otherwise constant outside.
  Vec3 at(double s) const;

 private:
  double angle_of(std::size_t span) const;

  std::vector<double> places_;  // of a loop, the first key once more at the end
  std::vector<Vec3> axes_, velocities_;
  double period_;
};

/// Where the great circle from `a` with the velocity `v` (square to a, rad per unit) has come to after `u`.
Vec3 along_great_circle(const Vec3& a, const Vec3& v, double u);
/// The velocity that leads from `a` to `b` in one unit.
Vec3 velocity_between(const Vec3& a, const Vec3& b);

}  // namespace riffler::plan
