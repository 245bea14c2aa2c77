// Mathematics shared by all topics: constants, rotations, perpendiculars.
#pragma once

#include <cmath>
#include <limits>
#include <numbers>

#include "base/functions.hpp"
#include "riffler/geom/vec.hpp"

namespace riffler::geom {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kTwoPi = 2 * kPi;     ///< rad in a full turn
inline constexpr double kDegree = kPi / 180;  ///< rad in one degree
inline constexpr double kRadian = 180 / kPi;  ///< degrees in one radian
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// `v` rotated by `angle` (rad) about the unit vector `k`, right-handed (Rodrigues).
inline Vec3 rotate_about(const Vec3& v, const Vec3& k, double angle) {
  return base::cos(angle) * v + base::sin(angle) * glm::cross(k, v) + (1 - base::cos(angle)) * glm::dot(k, v) * k;
}

/// `v` rotated by the rotation vector `turn` (rad).
inline Vec3 rotate_by(const Vec3& v, const Vec3& turn) {
  const double angle = glm::length(turn);
  return angle == 0 ? v : rotate_about(v, turn / angle, angle);
}

/// A unit vector perpendicular to the unit vector `v`.
inline Vec3 any_perpendicular(const Vec3& v) {
  return glm::normalize(glm::cross(v, std::abs(v.x) < 0.6 ? Vec3(1, 0, 0) : Vec3(0, 1, 0)));
}

}  // namespace riffler::geom

namespace riffler {
using geom::kDegree;
using geom::kInfinity;
using geom::kPi;
using geom::kRadian;
using geom::kTwoPi;
}  // namespace riffler
