// Signed distance to a cutter at rest, from its profile alone: what the independent reference for carving stands on.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "riffler/tool/profile.hpp"

namespace riffler::reference {

/// Where the cutter's surface is nearest to a point of the (radius, height) half-plane.
struct Nearest {
  double distance;             ///< mm, negative inside
  std::optional<Vec2> normal;  ///< gradient of the distance; nothing where rounding hides it (on an edge, a corner)
  /// Radius of a ball that touches the cutter there from outside and does not enter it, or 0 where none was looked for
  /// or found: the distance bends downwards no more than the distance from outside that ball. Infinity: a half-space.
  double free_radius = 0;
};

class CutterDistance {
 public:
  explicit CutterDistance(const tool::Profile& profile);

  /// rho ≥ 0; without a free radius.
  Nearest nearest(double rho, double z) const;
  double distance(double rho, double z) const { return nearest(rho, z).distance; }
  /// `at`, which is nearest(rho, z), with a free radius.
  Nearest with_free_radius(double rho, double z, Nearest at) const;

  /// What is between the heights of one step of the profile. Outside of the cutter its distance is the least of those
  /// of its slices. A convex cutter is not sliced.
  std::size_t slices() const { return slices_.size(); }
  /// As if the cutter were slice k alone, for a point outside of it; with a free radius.
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
    Vec2 way, normal;  // of the chord; the normal looks out of the cutter
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
