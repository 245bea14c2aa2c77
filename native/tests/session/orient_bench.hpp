// A corner to orient a tool in: a floor and a wall, along whose edge a ball runs.
#pragma once

#include "plan/parts.hpp"
#include "riffler/collide/collider.hpp"
#include "riffler/plan/path.hpp"
#include "riffler/session/orient_loop.hpp"
#include "riffler/tool/cutters.hpp"
#include "session/pen_bench.hpp"

namespace riffler::test {

inline constexpr double kBallRadius = 3, kWallHeight = 60, kShankFrom = 20, kShankRadius = 5;

/// Floor at z = 0 for y > 0, wall at y = 0 for z up to 60; both along x from 0 to 40.
inline Mesh corner() {
  return plan::trench({{80, 0}, {1e-3, 0}, {0, kWallHeight}, {-20, kWallHeight}}, -20, 40);
}

/// A ball-ended cutter with a shank that is wider than it.
inline Tool wide_shank() {
  return cutters::ball(2 * kBallRadius, kShankFrom).with_shank({{kShankFrom, kShankRadius, 60, kShankRadius}});
}

/// Along the edge from x = 2 to 38, a point each mm.
inline plan::PencilPath edge_path() {
  plan::PencilPath path;
  path.radius = kBallRadius;
  for (int k = 0; k <= 36; ++k) {
    const double x = 2 + k;
    path.centres.emplace_back(x, kBallRadius, kBallRadius);
    path.contacts.push_back({Vec3(x, kBallRadius, 0), Vec3(x, 0, kBallRadius)});
    path.normals.push_back({Vec3(0, 0, 1), Vec3(0, 1, 0)});
  }
  return path;
}

/// The axis that leans by `angle` (rad) from upright away from the wall.
inline Vec3 leaning(double angle) {
  return {0, std::sin(angle), std::cos(angle)};
}

/// The angle at which the shank's lower rim touches the wall: sin(a) · (20 − 3) − cos(a) · 5 = −3.
inline double touching_angle() {
  const double up = kShankFrom - kBallRadius;
  return std::atan2(kShankRadius, up) - std::asin(kBallRadius / std::hypot(up, kShankRadius));
}

}  // namespace riffler::test
