// Where a tool that comes down along its axis first touches a triangle.
#pragma once

#include <vector>

#include "riffler/tool/tool.hpp"

namespace riffler::plan {

/// The lower side of a convex piece as a height over the radius: level up to `flat`, from there on a cone or an arc up
/// to `rim`; a convex function that does not fall. Coming down on a triangle it stops where z − height(ρ), a concave
/// function of the place, is largest: in the triangle, on an edge, at a corner.
class LowerSide {
 public:
  explicit LowerSide(const tool::Piece& piece);

  double rim() const { return rim_; }
  /// For 0 ≤ ρ ≤ rim.
  double height(double rho) const;
  /// Where its slope is `slope` ≥ 0, or the radius nearest to that.
  double radius_of_slope(double slope) const;

  struct Stop {
    double tip;  ///< height of the tip when it touches
    Vec3 point;  ///< where
    bool touches = false;
  };
  /// Axis along z through (0, 0); raises `stop` where triangle abc stops the piece earlier.
  void meet(const Vec3& a, const Vec3& b, const Vec3& c, Stop& stop) const;

 private:
  void at(const Vec3& p, Stop& stop) const;
  void corner(const Vec3& p, Stop& stop) const;
  void edge(const Vec3& a, const Vec3& b, Stop& stop) const;
  void facet(const Vec3& a, const Vec3& b, const Vec3& c, Stop& stop) const;
  double best_on_line(double d, double slope) const;

  double bottom_, flat_, rim_;
  double cone_ = 0;  // slope, where it is one
  Vec2 centre_{0, 0};
  double arc_ = 0;  // radius, where it is one
};

}  // namespace riffler::plan
