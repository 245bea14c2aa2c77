// Convex parts of a tool, the units that are swept.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "riffler/tool/piece.hpp"

namespace riffler::sweep {

/// Frustum or Round (piece.hpp) as plain numbers. All fields are set for both types unless stated otherwise.
struct PieceShape {
  bool round, ball;       ///< ball: a Round that is a complete ball
  bool cut0, cut1;        ///< whether it ends in a flat face at z0, at z1; a pole is not a face
  double z0, r0, z1, r1;  ///< ends
  double slope, cosine;   ///< Frustum: dr/dz and 1 / √(1 + slope²)
  double e, zc, r;        ///< Round
  double support;         ///< Frustum: distance of its flank's plane from the tip, along the plane's normal
};

PieceShape shape_of(const tool::Piece& piece);
/// Whether a piece is a complete ball.
bool whole_ball(const tool::Piece& piece);

/// Pieces whose union is convex, from the tip upwards. Pieces that cannot reach the material may be missing.
struct ConvexGroup {
  static constexpr std::size_t kMax = 4;
  std::array<tool::Piece, kMax> pieces;
  std::size_t count = 0;
  double thinnest = 0;  ///< mm, the smaller of height and radius
  std::span<const tool::Piece> all() const { return {pieces.data(), count}; }
};

/// Whether two pieces of a group, one above the other, meet without an edge.
bool smooth_together(const tool::Piece& below, const tool::Piece& above);
/// Splits pieces, from the tip upwards, into groups with convex unions. Neighbouring groups overlap slightly.
std::vector<ConvexGroup> convex_groups(std::span<const tool::Piece> pieces);

}  // namespace riffler::sweep
