// Convex parts of a tool: what one step of it moves.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "riffler/tool/piece.hpp"

namespace riffler::sweep {

/// Frustum or Round (piece.hpp) in numbers; all fields are set for both, unless they say otherwise.
struct PieceShape {
  bool round, ball;       ///< ball: a Round that is a whole ball
  bool cut0, cut1;        ///< it ends in a flat face at z0, at z1; an end at a pole is none
  double z0, r0, z1, r1;  ///< ends
  double slope, cosine;   ///< Frustum: dr/dz and 1 / √(1 + slope²)
  double e, zc, r;        ///< Round
  double support;         ///< Frustum: height of its flank's plane over the tip, along the plane's normal
};

PieceShape shape_of(const tool::Piece& piece);
/// Whether a piece is a ball of which nothing is cut off.
bool whole_ball(const tool::Piece& piece);

/// Pieces whose union is convex, from the tip upwards; perhaps without what cannot reach the material.
struct ConvexGroup {
  static constexpr std::size_t kMax = 4;
  std::array<tool::Piece, kMax> pieces;
  std::size_t count = 0;
  double thinnest = 0;  ///< mm: the smaller of height and radius
  std::span<const tool::Piece> all() const { return {pieces.data(), count}; }
};

/// Whether two pieces of a group, one above the other, meet without an edge.
bool smooth_together(const tool::Piece& below, const tool::Piece& above);
/// Splits pieces, from the tip upwards, into groups whose unions are convex; neighbours overlap a little.
std::vector<ConvexGroup> convex_groups(std::span<const tool::Piece> pieces);

}  // namespace riffler::sweep
