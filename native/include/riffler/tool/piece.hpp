// Convex solids of revolution about the tool's axis: what a tool is the union of.
#pragma once

#include <variant>
#include <vector>

#include "riffler/geom/vec.hpp"

namespace riffler::tool {

/// Cylinder, cone or truncated cone between the heights z0 < z1 (mm from the tip along the axis), with flat ends of
/// radius r0 and r1 (either may be 0).
struct Frustum {
  double z0, r0, z1, r1;
};

/// The zone z0 ≤ ζ ≤ z1 of the solid { max(ρ − e, 0)² + (ζ − zc)² ≤ r² }, ρ the distance from the axis, ζ the height:
/// a ball (e = 0), a disc of radius e thickened by r (fillet, bull nose), or a barrel's lemon (e < 0; there
/// ρ − e > 0 everywhere). The left side is a convex function of the point in all three cases.
struct Round {
  double e, zc, r, z0, z1;
};

using Piece = std::variant<Frustum, Round>;

/// Largest distance of the piece from the axis, and its lowest and highest point along it.
double max_radius(const Piece& piece);
double bottom(const Piece& piece);
double top(const Piece& piece);
/// Radius of the piece at height z, which lies between bottom and top.
double radius_at(const Piece& piece, double z);

}  // namespace riffler::tool
