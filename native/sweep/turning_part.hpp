// A convex part of a tool on a short part of a move that turns its axis: what the kernel needs, in plain numbers.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "geom/pose.hpp"
#include "tool/piece.hpp"

namespace riffler {

/// Frustum or Round (piece.hpp) in numbers; all fields are set for both, unless they say otherwise.
struct PieceShape {
  bool round, ball;       ///< ball: a Round that is a whole ball
  double z0, r0, z1, r1;  ///< ends
  double slope, cosine;   ///< Frustum: dr/dz and 1 / √(1 + slope²)
  double e, zc, r;        ///< Round
  double inverse;         ///< 1 / r0 of a cylinder, 1 / r of a Round
  double support;         ///< Frustum: height of its flank's plane over the tip, along the plane's normal
};

/// A circle about the axis, perhaps thickened: a Round, or an edge (`thick` is 0). The planes that touch the group
/// there are those whose normal n has turn0 ≤ n · axis ≤ turn1.
struct Rim {
  double radius, z, thick, turn0, turn1;
};

/// Pieces whose union is convex, from the tip upwards; perhaps without what cannot reach the material.
struct ConvexGroup {
  static constexpr std::size_t kMost = 4;
  std::array<Piece, kMost> pieces;
  std::size_t count = 0;
  double thinnest = 0;  ///< mm: the smaller of height and radius
  std::span<const Piece> all() const { return {pieces.data(), count}; }
};

PieceShape shape_of(const Piece& piece);
/// Whether two pieces of a group, one above the other, meet without an edge.
bool smooth_together(const Piece& below, const Piece& above);
/// Splits pieces, from the tip upwards, into groups whose unions are convex; neighbours overlap a little.
std::vector<ConvexGroup> convex_groups(std::span<const Piece> pieces);

/// The group and its motion in plain numbers. Heights along the rays count from the tip's at the start of the part.
struct TurningBody {
  TurningBody(const ConvexGroup& group, const Motion& motion, double t0, double t1, double tolerance);

  std::size_t count;
  std::array<PieceShape, ConvexGroup::kMost> pieces;
  std::size_t rim_count;
  std::array<Rim, 2 * ConvexGroup::kMost + 1> rims;
  bool leans;     ///< whether some piece is a cone
  double widest;  ///< radius
  double t0, t1, origin;
  double tip[3], way[3];    ///< tip(t) = tip + t way, its height from the origin; way also is its velocity
  double axis[3], side[3];  ///< axis(t) = cos θ axis + sin θ side, θ = angle (t − middle)
  double middle, angle;
  /// The poses at t0 and t1.
  struct End {
    double tip[3], axis[3];
  } start, end;
  double spin[3];      ///< Ω, per unit of t
  double pull, drift;  ///< |Ω|³ and 3 |Ω|² |V|: bounds of the third derivative (docs/methods.md)
  double speed;        ///< |V|
  double along;        ///< mm along the ray that an end may miss
  double aside;        ///< mm in space that a supporting plane may be behind
  int deepest;         ///< halvings after which no point moves more than `aside`
};

}  // namespace riffler
