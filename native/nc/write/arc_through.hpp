// The arcs through two ends of a row of points that stay near all that lies between: what arc_fit.hpp looks for.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "riffler/geom/vec.hpp"

namespace riffler::nc {

/// Radii (mm) and the sweep (rad) of arcs that controls compute without trouble: from 180° on the centre follows badly
/// from rounded ends, and a circle of many metres is a straight line to them.
inline constexpr double kMinArcRadius = 0.01, kMaxArcRadius = 1e4, kMaxArcSweep = 3.05;
/// Points nearer to each other than this (mm) are one: nobody has gone back who went back by less.
inline constexpr double kSamePoint = 1e-9;

/// Every so-many-th of `count` points is looked at first: a run that is far too long shows there.
inline std::size_t stride(std::size_t count) {
  return count / 16 + 1;
}

/// A circular arc in a coordinate plane; along the normal it rises evenly with the angle.
struct PlaneArc {
  Axis normal = Axis::Z;
  Vec2 centre{0};    ///< in the cyclic frame of the normal (geom/vec.hpp)
  double sweep = 0;  ///< rad, > 0 counter-clockwise seen against the normal
};

/// An arc from the first to the last point that is within `tolerance` (mm) of the polyline, and the polyline of it,
/// both at the same angle about the centre, which never falls along the polyline; nothing where none was found.
/// Counts the points it looks at in `looked_at`.
std::optional<PlaneArc> arc_within(std::span<const Vec3> points, Axis normal, double tolerance, std::size_t& looked_at);

/// Of the arcs that arc_within() accepts, the one whose circle is nearest to the points: `found` where there is none
/// better. Chords of an arc give that arc.
PlaneArc nearest_arc(std::span<const Vec3> points, const PlaneArc& found, double tolerance, std::size_t& looked_at);

}  // namespace riffler::nc
