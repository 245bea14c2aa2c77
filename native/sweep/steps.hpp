// A move of the whole tool → straight steps of its convex pieces.
#pragma once

#include <cstdint>
#include <functional>

#include "geom/pose.hpp"
#include "sweep/swept_piece.hpp"

namespace riffler {

/// One straight step of one piece.
struct Step {
  std::uint32_t move;  ///< index of the move it belongs to
  double t;            ///< middle of the step, in the move's own t
  SweptPiece body;
};

/// How many straight steps a rotating move of a piece needs. In each step the piece keeps the orientation of the step's
/// middle and its pivot (height `pivot` on the axis) goes along the chord of its true path. With φ the move's angle, a
/// point at the distance ≤ `lever` from the pivot is displaced by at most lever · φ/(2N) from the orientation and
/// |pivot| (φ/N)²/8 from the chord (the tip is straight, the pivot's offset turns with the axis). Both together stay
/// below `bound`; the swept bodies then differ by at most that in the sense of Hausdorff (docs/methods.md, "Carving").
std::uint64_t step_count(double angle, double lever, double pivot, double bound);

/// Calls `sink` for every step of `piece` on `motion` that can touch `box`, in order of t. Poses, box and steps are in
/// the cyclic frame of one grid. Every interval end of the union lies within `tolerance` of the exact one, along the
/// ray or, where the ray grazes, in space.
void for_each_step(const Piece& piece, const Motion& motion, std::uint32_t move, const Box3& box, double tolerance,
                   const std::function<void(const Step&)>& sink);

}  // namespace riffler
