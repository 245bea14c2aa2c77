// Unit normals of rational Bézier nets, also in poles.
#pragma once

#include "nurbs/bezier.hpp"

namespace riffler::nurbs {

/// In the direction of dS/du × dS/dv. Where that is 0, its limit on the line to the middle of the net; 0 if it is 0
/// there as well.
Vec3 normal_of(const Vec4* net, const Degrees& degrees, const Vec2& at);

}  // namespace riffler::nurbs
