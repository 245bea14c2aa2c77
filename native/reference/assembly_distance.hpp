// Signed distance to a whole tool at rest (cutter, shank and holder), the base of the independent reference for
// contact. It shares only its input with tool/outline, the profile and the frusta: it computes no levels and no joined
// outline.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "riffler/geom/pose.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::reference {

/// Corners of a triangle.
using Corners = std::array<Vec3, 3>;

/// Distance to the union of the solids. Outside it is the smallest of their distances. Inside, the nearest point of the
/// union's surface is a foot on an edge of one of the solids, an edge's end, or a crossing of two edges, and a small
/// step from it leads out of all solids. All such candidates are examined.
class AssemblyDistance {
 public:
  explicit AssemblyDistance(const Tool& tool);

  /// Distance from (rho, z) in the (radius, height) half-plane, rho ≥ 0; negative inside.
  double distance(double rho, double z) const;
  double operator()(const Vec3& p, const Pose& pose) const;
  bool inside(double rho, double z) const;

  /// Upper bound on the depth of the triangle's points in the tool, ≥ 0, from a tangent plane; no value where the
  /// tangent gives no bound. `p` is a point of the triangle's plane, at most `radius` from every point of the triangle.
  /// The bound's error is of second order in the radius; from the distance at `p` alone it would be of first order.
  std::optional<double> tangent_bound(const Corners& triangle, const Vec3& p, double radius, const Pose& pose) const;
  /// Whether no point within `radius` of p is in the tool, by cylinders around its solids.
  bool beyond(const Vec3& p, double radius, const Pose& pose) const;

 private:
  struct Edge {  // of a solid's outline; heights never fall
    Vec2 from, to;
    std::optional<Vec2> centre;   // of an arc
    double radius = 0, side = 1;  // of an arc; side: +1 bulges, −1 is a hollow
  };
  struct Solid {
    std::vector<Edge> edges;  // from the axis at the bottom to the axis at the top
    bool convex = true;
    double radius = 0, low = 0, high = 0;  // of the cylinder round it
  };
  struct Nearest {
    double distance;
    Vec2 at;                       // on the union's surface
    const Solid* solid = nullptr;  // whose edge it is on; null at a corner
    const Edge* edge = nullptr;
  };

  static bool inside(const Solid& solid, double rho, double z);
  static bool convex(const std::vector<Edge>& edges);
  static double outside(const Solid& solid, const Vec2& p);
  static std::optional<Vec2> foot(const Edge& e, const Vec2& p);
  Nearest nearest(double rho, double z) const;
  bool on_surface(const Vec2& q) const;
  void add_crossings(const Edge& a, const Edge& b);
  void add_if_on_surface(const Vec2& q);

  std::vector<Solid> solids_;
  std::vector<Vec2> corners_;  // ends and crossings of edges, on the union's surface
  double step_;                // mm: length of the steps from a candidate out of the solids
};

}  // namespace riffler::reference
