// Arcs through both ends of a row of points that stay near all points between: the candidates of arc_fit.hpp.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "riffler/geom/vec.hpp"

namespace riffler::nc {

/// Radii (mm) and sweep (rad) of arcs that controls compute reliably: from 180° on, rounded ends determine the centre
/// poorly, and a circle of many metres is a straight line to a control.
inline constexpr double kMinArcRadius = 0.01, kMaxArcRadius = 1e4, kMaxArcSweep = 3.05;
/// Points closer than this (mm) are one: a step back by less does not count.
inline constexpr double kSamePoint = 1e-9;

/// The stride for a first, sparse look at `count` points: a run that is far too long fails there.
inline std::size_t stride(std::size_t count) {
  return count / 16 + 1;
}

/// A circular arc in a coordinate plane that rises evenly along the normal.
struct PlaneArc {
  Axis normal = Axis::Z;
  Vec2 centre{0};    ///< in the cyclic frame of the normal (geom/vec.hpp)
  double sweep = 0;  ///< rad, > 0 counter-clockwise seen against the normal
};

/// An arc from the first to the last point within `tolerance` (mm) of the polyline, and vice versa, compared at equal
/// angles about the centre; the angle never decreases along the polyline. No value if none was found. Adds the number
/// of points examined to `looked_at`.
std::optional<PlaneArc> arc_within(std::span<const Vec3> points, Axis normal, double tolerance, std::size_t& looked_at);

/// Among the arcs that arc_within() accepts, the one whose circle is nearest to the points, or `found` if none is
/// better. Chords of an arc give that arc.
PlaneArc nearest_arc(std::span<const Vec3> points, const PlaneArc& found, double tolerance, std::size_t& looked_at);

}  // namespace riffler::nc
