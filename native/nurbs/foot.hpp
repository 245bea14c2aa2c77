// The nearest point of one Bézier net, found by Newton's method: a local minimum.
#pragma once

#include "nurbs/bezier.hpp"

namespace riffler::nurbs {

/// Walks from the nearest of `at` and the corners to a minimum of the distance between the net and the origin,
/// within the unit square. Returns the squared distance, which is never larger than that at the start.
double walk_to_foot(const Vec4* net, const Degrees& degrees, Vec2& at);

}  // namespace riffler::nurbs
