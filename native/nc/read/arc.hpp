// Circular arcs of G2 and G3, in their plane.
#pragma once

#include "riffler/geom/vec.hpp"

namespace riffler::nc {

/// From `centre` + r0 at angle `start` (rad) through `sweep` (rad, > 0 counter-clockwise) to radius r1. If the two ends
/// lie on slightly different circles, the radius changes evenly.
struct Arc {
  Vec2 centre;
  double r0, r1, start, sweep;

  /// The same arc with `turns` − 1 additional whole turns.
  Arc with_turns(int turns) const;
  Vec2 at(double t) const;
  double length() const;
  /// Number of equal chords that stay within `tolerance` (mm) of the arc.
  int chords(double tolerance) const;
};

/// Largest distance of an arc's end from its circle, mm: stricter than LinuxCNC, which accepts 0.028 and more.
inline constexpr double kArcMiss = 0.005;
/// The largest value of option arc_tolerance, mm.
inline constexpr double kMaxArcMiss = 1;
/// The same for an arc given by its radius, and the smallest radius about a given centre, mm: LinuxCNC's values.
inline constexpr double kRadiusMiss = 0.00254, kMinRadius = 0.00127;
/// Ends closer than this (mm) are one point, and the arc a full circle.
inline constexpr double kFullCircle = 1e-6;

/// Throw std::invalid_argument with the reason: the end misses the circle by more than `miss` (mm), a radius below
/// kMinRadius or 0, a full circle by its radius. `radius` < 0 selects the arc of more than half a turn.
Arc arc_about(const Vec2& from, const Vec2& to, const Vec2& centre, bool clockwise, double miss = kArcMiss);
Arc arc_of_radius(const Vec2& from, const Vec2& to, double radius, bool clockwise, double miss = kRadiusMiss);
/// The arc that leaves `from` along `direction`, of any length. Also throws without a direction, or if `to` lies
/// straight ahead or behind.
Arc tangent_arc(const Vec2& from, const Vec2& to, const Vec2& direction, double miss = kArcMiss);

}  // namespace riffler::nc
