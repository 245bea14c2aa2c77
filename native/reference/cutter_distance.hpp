// Signed distance to a cutter at rest, from its profile alone: the base of the independent reference for carving.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "riffler/tool/profile.hpp"

namespace riffler::reference {

/// The point of the cutter's surface nearest to a point of the (radius, height) half-plane.
struct Nearest {
  double distance;             ///< mm, negative inside
  std::optional<Vec2> normal;  ///< gradient of the distance; no value where rounding hides it (on an edge, a corner)
  /// Radius of a ball that touches the cutter there from outside and does not enter it; infinity: a half-space; 0: none
  /// searched or found. The distance bends downwards no more than the distance from the outside of that ball.
  double free_radius = 0;
};

class CutterDistance {
 public:
  explicit CutterDistance(const tool::Profile& profile);

  /// The nearest point to (rho, z), rho ≥ 0, without a free radius.
  Nearest nearest(double rho, double z) const;
  double distance(double rho, double z) const { return nearest(rho, z).distance; }
  /// Adds the free radius to `at`, the result of nearest(rho, z).
  Nearest with_free_radius(double rho, double z, Nearest at) const;

  /// Number of slices; a slice is the part of the cutter between the heights of one step of the profile. Outside the
  /// cutter, its distance is the smallest of its slices' distances. A convex cutter is not sliced.
  std::size_t slices() const { return slices_.size(); }
  /// The nearest point of slice k alone, with a free radius, for a point outside the slice.
  Nearest nearest_in_slice(std::size_t k, double rho, double z) const;

  /// Largest distance of the cutter from its tip, mm.
  double reach() const { return reach_; }

 private:
  struct Arc {
    Vec2 centre;
    double radius, side;  // side: +1 bulges, −1 is a hollow
  };
  struct Edge {  // one step of the closed outline
    Vec2 from, to;
    std::optional<Arc> arc;
    double length;     // of the chord
    Vec2 way, normal;  // of the chord; the normal points out of the cutter
  };
  class Search;

  static Edge edge(const Vec2& from, const Vec2& to, const std::optional<Vec2>& centre);
  static bool convex(const std::vector<Edge>& edges);
  void add_slices(const Edge& e);
  bool inside(double rho, double z) const;
  double beside_hollow(const Edge& e, const Vec2& foot, const Vec2& normal) const;

  std::vector<Edge> edges_;
  std::vector<std::array<Edge, 3>> slices_;  // bottom, outside, top
  bool convex_;
  double reach_;
};

}  // namespace riffler::reference
