// A move of the whole tool → steps of its convex pieces: one straight step, or short turning parts.
#pragma once

#include <cstdint>
#include <functional>
#include <variant>

#include "geom/pose.hpp"
#include "sweep/footprint.hpp"
#include "sweep/swept_piece.hpp"
#include "sweep/turning_piece.hpp"

namespace riffler {

/// One step of one piece.
class Step {
 public:
  Step(std::uint32_t move, Footprint footprint, SweptPiece body)
      : move_(move), footprint_(footprint), body_(std::move(body)) {}
  Step(std::uint32_t move, Footprint footprint, TurningPiece body)
      : move_(move), footprint_(footprint), body_(std::move(body)) {}

  /// Index of the move it belongs to.
  std::uint32_t move() const { return move_; }
  const Footprint& footprint() const { return footprint_; }
  /// The stretches of the ray through (u, v) inside the swept body; ends beyond `material` need not be exact.
  void hit(double u, double v, const Interval& material, SweptIntervals& out) const;
  /// Unit normal, out of the body, at one end of a stretch.
  Vec3 normal(double u, double v, const SweptHit& hit, double t) const;

 private:
  std::uint32_t move_;
  Footprint footprint_;
  std::variant<SweptPiece, TurningPiece> body_;
};

/// How many parts a turning move needs so that the sets which TurningPiece takes for convex are so up to `bound` mm.
/// A material point r of the tool moves as X(t) = tip(t) + R(t) r; over a part of angle φ/N and way P/N it leaves its
/// chord by at most (D φ² + 2 P φ) / (8 N²), D the greatest distance of a point from the tip. Along their chords all
/// points move by an affine map of t, whose departure from a translation bends the section by no more than the same
/// amount. A function that departs so much from a convex one may fall by four times that behind a rising slope, so it
/// is (D φ² + 2 P φ) / (2 N²) that must not exceed `bound` (docs/methods.md, "Carving").
std::uint64_t part_count(double angle, double way, double lever, double bound);

/// Calls `sink` for every step of `piece` on `motion` that can touch `box`, in order of t. Poses, box and steps are in
/// the cyclic frame of one grid; `motion` must outlive the steps. Every interval end of the union lies within
/// `tolerance` of the exact one, along the ray or, where the ray grazes, in space.
void for_each_step(const Piece& piece, const Motion& motion, std::uint32_t move, const Box3& box, double tolerance,
                   const std::function<void(Step&&)>& sink);

}  // namespace riffler
