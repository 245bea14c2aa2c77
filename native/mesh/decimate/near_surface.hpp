// Decides whether all of a triangle is near a surface.
#pragma once

#include <array>
#include <vector>

#include "mesh/closest.hpp"

namespace riffler::mesh {

using Corners = std::array<Vec3, 3>;

/// Triangles as a mesh that shares no vertices.
Mesh mesh_of(const std::vector<Corners>& triangles);

/// A surface, and the distance that counts as near it.
///
/// The points near one triangle form a convex set, so a convex piece is near if its corners are near one triangle. A
/// piece that is not is cut along the edges of the triangle nearest to its centre: what lies over that triangle is
/// tested again, and so are the up to three parts around it. Where a surface is flat, that takes about as many pieces
/// as triangles lie under the piece, however thin they are; where it is not, pieces are halved.
class NearSurface {
 public:
  NearSurface(const std::vector<Corners>& surface, double tolerance);

  /// Whether every point of `place` is at most the tolerance away. A triangle that takes more than `most` pieces counts
  /// as far. Pieces narrower than kGrain of the tolerance are left out.
  bool holds(const Corners& place, int most) const;

 private:
  static constexpr double kGrain = 1e-9;
  static constexpr int kCorners = 12;  // of a piece that is cut, at most
  static constexpr int kHalvings = 24;
  /// A convex polygon.
  struct Piece {
    std::array<Vec3, 2 * kCorners> point;  // a cut of a piece that rounding made concave may add several
    int corners = 0;
    int hint = -1;  // a triangle nearby
    int halvings = 0;

    void add(const Vec3& p) { point[corners++] = p; }
    Vec3 centre() const;
  };

  bool near_triangle(const Piece& piece, int triangle) const;
  bool has_width(const Piece& piece) const;
  void cut(const Piece& piece, const Vec3& at, const Vec3& unit, Piece& in, Piece& out) const;
  bool cut_along(const Piece& piece, int triangle, std::vector<Piece>& open) const;
  void halve(const Piece& piece, std::vector<Piece>& open) const;

  Closest closest_;
  std::vector<Corners> triangles_;
  double tolerance_;
};

}  // namespace riffler::mesh
