// Smooths points of a surface: each moves towards the plane fitted to its neighbours.
#pragma once

#include <vector>

#include "dexel/smooth/end_points.hpp"
#include "riffler/base/progress.hpp"

namespace riffler::dexel {

/// A point of the surface before and after smoothing; world frame, unit normals out of the material.
struct MovedPoint {
  Vec3 before, after;
  Vec3 normal_before, normal_after;
  double way = 0;  ///< length of its displacement, mm

  bool moved() const { return way > 0; }
};

/// A brush. Its effect is `strength` (0 … 1) at the centre and fades to 0 at `radius` (mm).
struct Brush {
  Vec3 centre;
  double radius;
  double strength;

  /// The brush's effect at p: (1 − t⁴)² times the strength. Nearly constant up to half the radius, smooth at the rim.
  double share(const Vec3& p) const;
};

/// Radius ρ of the neighbourhood of a point, in pitches, with the weight (1 − d²/ρ²)³. On a sphere of radius R (many
/// pitches), a point moves inwards by ρ²/10 R, because the weighted mean of the squared distance in a plane is ρ²/5.
/// Noise of points one pitch apart shrinks by the factor √(16 / 7 π ρ²), to about a fifth.
inline constexpr double kRelaxReach = 4;

/// Maximum displacement of a point, in pitches.
inline constexpr double kFarthestMove = 1;

/// Weight that separates sheets of the surface, from the cosine of the angle between two normals. It is 1 up to 120°,
/// so that edges become round and the rims of thin walls wear off, and falls to 0 at 162°, so that the two sides of a
/// wall or gap do not mix.
inline double same_sheet(double cosine) {
  if (cosine >= -0.5) return 1;
  if (cosine <= -0.95) return 0;
  const double t = (cosine + 0.95) / 0.45;
  return t * t * (3 - 2 * t);
}

/// Points do not move if they are held, lie outside the brush or would move by less than 1e-9 h, as all points of a
/// plane would.
std::vector<MovedPoint> relax(const std::vector<EndPoint>& points, double pitch, const Brush& brush,
                              const Progress& progress = {});

}  // namespace riffler::dexel
