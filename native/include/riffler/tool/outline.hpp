// The outline of a tool with shank and holder in the (radius, height) half-plane, and how far points are from it.
#pragma once

#include <optional>
#include <vector>

#include "riffler/tool/tool.hpp"

namespace riffler::tool {

/// One step of an outline, upwards or level, with the solid on its left: on the side of the axis.
struct OutlineEdge {
  Vec2 from, to;  ///< (radius, height from the tip), mm
  std::optional<Vec2> centre;
  double bulge = 0;  ///< radius of an arc, negative where it is a hollow; 0: a line
  Part part;         ///< what it belongs to
};

/// Whether a point is in the sector of an arc: its nearest point of the circle lies on the arc. Told by areas, as where
/// the circle is level heights cannot tell: rounded, those of 1e-8 of it are all the same.
bool faces(const OutlineEdge& arc, const Vec2& p);
/// Radius of an edge whose height rises, at a height between its ends.
double radius_at(const OutlineEdge& e, double z);

/// Signed distance of a solid of revolution in space: for a point at height ζ and ρ from the axis it is that of (ρ, ζ)
/// in the half-plane, exact outside and inside, for the union of all pieces.
class Outline {
 public:
  struct Nearest {
    double distance;  ///< mm, negative inside
    Vec2 point;       ///< the nearest of the outline
    Vec2 normal;      ///< out of the solid: the gradient of the distance, at corners towards the point
    Part part;
  };

  /// Hollow arcs are exact here, not the cones that stand for them where rays are cut.
  explicit Outline(const Tool& tool);

  /// From the tip upwards; where the tool has a gap, its edges come back to the axis.
  const std::vector<OutlineEdge>& edges() const { return edges_; }
  /// rho ≥ 0.
  Nearest nearest(double rho, double z) const;
  bool inside(double rho, double z) const;

 private:
  std::vector<OutlineEdge> edges_;
};

/// The edge as a polyline that stays within `tolerance` mm of it, both ends included.
std::vector<Vec2> polyline(const OutlineEdge& edge, double tolerance);

}  // namespace riffler::tool
