// Signed distance to a cutter at rest, from its profile alone: the base of the independent reference for carving.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "riffler/tool/profile.hpp"

namespace riffler::reference {

/// The point of the cutter's surface nearest to a point of the (radius, height) half-plane.
struct Nearest {
  double distance;             ///< mm, negative inside
  std::optional<Vec2> normal;  ///< gradient of the distance; no value where rounding hides it (on an edge, a corner)
  Vec2 support{0, 0};  ///< of a convex outline: a normal there with which all of it is behind; always has a value
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
  /// The nearest point of slice k alone, with a free radius if (rho, z) is outside the slice.
  Nearest nearest_in_slice(std::size_t k, double rho, double z) const;
  /// Whether the cutter, or else every slice, is convex. Their distances are then convex functions of the point.
  bool convex() const { return convex_; }
  bool slices_convex() const { return slices_convex_; }

  /// Largest distance of the cutter from its tip, mm.
  double reach() const { return reach_; }

 private:
  struct Arc {
    Vec2 centre;
    double radius, side;  // side: +1 bulges, −1 is a hollow
  };
  struct Cone {  // the normals of a convex corner, in the order of the outline
    Vec2 first, last;
  };
  struct Edge {  // one step of the closed outline
    Vec2 from, to;
    std::optional<Arc> arc;
    double length;     // of the chord
    Vec2 way, normal;  // of the chord; the normal points out of the cutter
    Cone at_from{}, at_to{};
  };
  class Search;

  static Edge edge(const Vec2& from, const Vec2& to, const std::optional<Vec2>& centre);
  static bool convex(const std::vector<Edge>& edges);
  bool behind(const Vec2& foot, const Vec2& normal) const;
  static void add_cones(std::span<Edge> outline);
  void add_slices(const Edge& e);
  static bool inside(const Edge& e, double rho, double z);
  bool inside(double rho, double z) const;
  double beside_hollow(const Edge& e, const Vec2& foot, const Vec2& normal) const;

  std::vector<Edge> edges_;
  std::vector<std::array<Edge, 3>> slices_;  // bottom, outside, top
  bool convex_, slices_convex_ = true;
  double reach_;
};

}  // namespace riffler::reference
