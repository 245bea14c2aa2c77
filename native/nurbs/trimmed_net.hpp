// Bézier nets of parts of Bézier nets.
#pragma once

#include "nurbs/bezier.hpp"
#include "nurbs/trim_region.hpp"

namespace riffler::nurbs {

/// Degrees of the net over a trapezoid: (p, q) for a rectangle, otherwise (p, p + q).
Degrees degrees_over(const Degrees& degrees, const Trapezoid& piece);

/// The net over the unit square of `piece` (Trapezoid::at), which is in the unit square of `net`: the same surface, not
/// an approximation. Control points are convex combinations of those of `net`. `out`: degrees_over(…).size() points.
void trimmed_net(const Vec4* net, const Degrees& degrees, const Trapezoid& piece, Vec4* out);

/// The curve of degree p + q over the straight line from a to b, both in the unit square of `net`: p + q + 1 points.
void border_net(const Vec4* net, const Degrees& degrees, const Vec2& a, const Vec2& b, Vec4* out);

/// Largest lengths (mm) of the control polygons along u and v: upper bounds of the lengths of parameter lines.
Vec2 side_lengths(const Vec4* net, const Degrees& degrees);

}  // namespace riffler::nurbs
