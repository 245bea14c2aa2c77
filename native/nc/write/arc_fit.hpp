// Fits lines and arcs to runs of short straight moves: G2 and G3 instead of many blocks of G1.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "riffler/geom/vec.hpp"

namespace riffler::nc {

/// A piece from the end of the previous one (at first point 0) to point `last`: a line, or an arc of less than half a
/// turn in a coordinate plane that rises evenly along the plane's normal (a helix if the ends' heights differ). Ends
/// are points of the run.
struct FittedPiece {
  std::size_t last = 0;
  bool arc = false;
  Axis normal = Axis::Z;   ///< Z: XY plane (G17), Y: ZX (G18), X: YZ (G19)
  Vec3 centre{0};          ///< mm, of an arc; along the normal, the coordinate of the arc's start
  bool clockwise = false;  ///< G2, seen against the normal
};

/// An arc replaces at least this many moves.
inline constexpr std::size_t kMinArcMoves = 3;
/// Smallest tolerance, mm: coordinates are written with 5 decimals.
inline constexpr double kMinFitTolerance = 2e-5;

/// Few lines and arcs within `tolerance` (mm) of the polyline through `points`, and vice versa, in order: corresponding
/// points pair up along both, and neither goes back where the other does not. Moves that turn back, or are too long to
/// be replaced within the tolerance, stay lines. Greedy: every piece extends as far as possible; if both reach equally
/// far, it is a line. Time O(n log n).
///
/// Empty for fewer than two points. Throws std::invalid_argument naming the row of a point that is not finite, or a
/// tolerance below kMinFitTolerance. Adds the number of points examined to `looked_at`.
std::vector<FittedPiece> fit_arcs(std::span<const Vec3> points, double tolerance, std::size_t* looked_at = nullptr);

}  // namespace riffler::nc
