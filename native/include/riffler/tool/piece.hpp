// The convex solids of revolution about the tool's axis that a tool is the union of.
#pragma once

#include <variant>
#include <vector>

#include "riffler/geom/vec.hpp"

namespace riffler::tool {

/// Cylinder, cone or truncated cone between the heights z0 < z1 (mm from the tip along the axis). Its flat ends have
/// the radii r0 and r1; either may be 0.
struct Frustum {
  double z0, r0, z1, r1;
};

/// The zone z0 ≤ ζ ≤ z1 of the solid { max(ρ − e, 0)² + (ζ − zc)² ≤ r² }, with ρ the distance from the axis and ζ the
/// height, mm: a ball (e = 0), a disc of radius e thickened by r (bull nose), or the spindle shape of a barrel (e < 0,
/// where ρ − e > 0 everywhere). The left side is convex in all three cases.
struct Round {
  double e, zc, r, z0, z1;
};

using Piece = std::variant<Frustum, Round>;

/// Largest distance of the piece from the axis, mm.
double max_radius(const Piece& piece);
/// Lowest and highest point along the axis, mm.
double bottom(const Piece& piece);
double top(const Piece& piece);
/// Radius of the piece at height z between bottom and top, mm.
double radius_at(const Piece& piece, double z);

}  // namespace riffler::tool
