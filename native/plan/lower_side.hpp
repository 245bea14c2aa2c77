// Finds where a tool that comes down along its axis first touches a triangle.
#pragma once

#include <optional>
#include <vector>

#include "riffler/tool/tool.hpp"

namespace riffler::plan {

/// The lower side of a convex piece as height over radius: flat up to `flat`, then a cone or an arc up to `rim`; a
/// convex, non-decreasing function. Coming down on a triangle, it stops where z − height(ρ), a concave function of the
/// place, is largest: inside the triangle, on an edge or at a corner.
class LowerSide {
 public:
  explicit LowerSide(const tool::Piece& piece);

  double rim() const { return rim_; }
  /// Height (mm) at radius `rho`, 0 ≤ ρ ≤ rim.
  double height(double rho) const;
  /// Radius at which the slope is `slope` ≥ 0, or the nearest possible.
  double radius_of_slope(double slope) const;

  struct Stop {
    double tip;  ///< height of the tip at the contact, mm
    Vec3 point;  ///< the contact point
    bool touches = false;
  };
  /// Raises `stop` if triangle abc stops the piece earlier. The axis runs along z through (0, 0).
  void meet(const Vec3& a, const Vec3& b, const Vec3& c, Stop& stop) const;

  /// How the plane of a triangle stops the piece: no lower than the triangle.
  struct OnPlane {
    Vec2 slope;  ///< of the plane, along x and y
    Vec2 place;  ///< the contact, from the axis
    double tip;  ///< height of the tip with the axis through (0, 0), mm, and the most that rounding takes from it
  };
  /// None of a triangle so steep or thin that rounding changes its plane.
  std::optional<OnPlane> on_plane(const Vec3& a, const Vec3& b, const Vec3& c) const;

 private:
  void at(const Vec3& p, Stop& stop) const;
  void corner(const Vec3& p, Stop& stop) const;
  void edge(const Vec3& a, const Vec3& b, Stop& stop) const;
  void facet(const Vec3& a, const Vec3& b, const Vec3& c, Stop& stop) const;
  double best_on_line(double d, double slope) const;

  double bottom_, flat_, rim_;
  double cone_ = 0;  // slope of the cone, if there is one
  Vec2 centre_{0, 0};
  double arc_ = 0;  // radius of the arc, if there is one
};

}  // namespace riffler::plan
