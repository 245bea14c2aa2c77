// Smoothing of points of a surface: each moves towards the plane that fits those around it.
#pragma once

#include <vector>

#include "dexel/smooth/end_points.hpp"
#include "riffler/base/progress.hpp"

namespace riffler::dexel {

/// A point of the surface before and after; world frame, unit normals out of the material.
struct MovedPoint {
  Vec3 before, after;
  Vec3 normal_before, normal_after;
  double way = 0;  ///< mm that it moved, not negative

  bool moved() const { return way > 0; }
};

/// A brush: strength 0 … 1 at the centre, fading out towards its radius (mm).
struct Brush {
  Vec3 centre;
  double radius;
  double strength;

  /// (1 − t⁴)²: nearly whole as far as half the radius, and smooth at the rim.
  double share(const Vec3& p) const;
};

/// How far around a point others count (pitches), with the weight (1 − d²/ρ²)³: on a sphere of radius R (many pitches)
/// the point moves inwards by ρ²/10 R, as the weighted mean of the squared distance on a plane is ρ²/5. Noise of points
/// a pitch apart shrinks to √(16 / 7 π ρ²), about a fifth.
inline constexpr double kRelaxReach = 4;

/// No point moves farther than this (pitches).
inline constexpr double kFarthestMove = 1;

/// Points of one sheet only see each other: 1 where two normals make an angle up to 120°, so that edges become round
/// and the rims of thin walls wear off, falling to 0 at 162°, so that the two sides of a wall or a gap do not mix. Of
/// the angle's cosine.
inline double same_sheet(double cosine) {
  if (cosine >= -0.5) return 1;
  if (cosine <= -0.95) return 0;
  const double t = (cosine + 0.95) / 0.45;
  return t * t * (3 - 2 * t);
}

/// Points that are held, that lie beyond the brush or that would move by less than 1e-9 h stay as they are: those of
/// a plane do.
std::vector<MovedPoint> relax(const std::vector<EndPoint>& points, double pitch, const Brush& brush,
                              const Progress& progress = {});

}  // namespace riffler::dexel
