// On which side of a surface a point is, for surfaces that need not be closed.
#pragma once

#include "collide/surface.hpp"

namespace riffler {

/// Generalized winding number (Jacobson, Kavan and Sorkine-Hornung, ACM TOG 32(4) (2013) 33): 1 inside of a closed
/// surface whose normals point outwards, 0 outside, in between near openings. The sum over all triangles, so for few
/// points.
double winding_number(const Surface& surface, const Vec3& p);

}  // namespace riffler
