// The outline of a tool with shank and holder in the (radius, height) half-plane, and distances from it.
#pragma once

#include <optional>
#include <vector>

#include "riffler/tool/tool.hpp"

namespace riffler::tool {

/// One edge of an outline, rising or level. The solid is on its left, the side of the axis.
struct OutlineEdge {
  Vec2 from, to;  ///< (radius, height from the tip), mm
  std::optional<Vec2> centre;
  double bulge = 0;  ///< radius of the arc, negative if concave; 0: straight line
  Part part;         ///< the part of the tool that the edge belongs to
};

/// Whether a point lies in the sector of an arc, so that its nearest point of the circle is on the arc. Compares areas,
/// not heights: where the circle is level, points up to 1e-8 of the radius apart have the same rounded height.
bool faces(const OutlineEdge& arc, const Vec2& p);
/// Radius of a rising edge at height z between its ends, mm.
double radius_at(const OutlineEdge& e, double z);

/// Signed distance from the union of all pieces of a tool. A solid of revolution has the same distance in space as in
/// the half-plane: a point at height ζ and distance ρ from the axis has the distance of (ρ, ζ). Exact outside and
/// inside.
class Outline {
 public:
  /// Result of `nearest`.
  struct Nearest {
    double distance;  ///< mm, negative inside
    Vec2 point;       ///< nearest point of the outline
    Vec2 normal;      ///< out of the solid: the gradient of the distance; at corners, towards the query point
    Part part;
  };

  /// Uses the exact concave arcs, not the cones that replace them when rays are cut.
  explicit Outline(const Tool& tool);

  /// Edges from the tip upwards. At a gap in the tool they return to the axis.
  const std::vector<OutlineEdge>& edges() const { return edges_; }
  /// The nearest point of the outline to (rho, z), mm; rho ≥ 0.
  Nearest nearest(double rho, double z) const;
  /// Whether the point (rho, z), mm, is inside the solid; rho ≥ 0.
  bool inside(double rho, double z) const;

 private:
  std::vector<OutlineEdge> edges_;
};

/// Approximates the edge by a polyline within `tolerance` mm, both ends included.
std::vector<Vec2> polyline(const OutlineEdge& edge, double tolerance);

}  // namespace riffler::tool
