// Lines and arcs for a run of short straight moves: G2 and G3 where many blocks of G1 would be.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "riffler/geom/vec.hpp"

namespace riffler::nc {

/// From the end of the piece before, at first from point 0, to point `last`: a line, or an arc of less than half a turn
/// in a coordinate plane that rises along the plane's normal evenly with the angle (a helix where the ends' heights
/// differ). Ends are points of the run.
struct FittedPiece {
  std::size_t last = 0;
  bool arc = false;
  Axis normal = Axis::Z;   ///< Z: XY plane (G17), Y: ZX (G18), X: YZ (G19)
  Vec3 centre{0};          ///< mm, of an arc; along the normal it is where the arc begins
  bool clockwise = false;  ///< G2: seen against the normal
};

/// Arcs stand for at least so many moves.
inline constexpr std::size_t kMinArcMoves = 3;
/// The least tolerance, mm: coordinates are written with 5 decimals.
inline constexpr double kMinFitTolerance = 2e-5;

/// Few lines and arcs that are within `tolerance` (mm) of the polyline through `points`, and it of them, in order:
/// what is beside a point of the one is a point of the other, and neither goes back where the other does not. Moves
/// that turn back, or are longer than a tolerance allows to replace, stay lines of their own. The greedy choice: every
/// piece goes as far as it can be made to go, the line where both go equally far. Takes time in proportion to n log n.
///
/// Of fewer than two points nothing. Throws std::invalid_argument naming the row of a point that is not finite, or a
/// tolerance of less than kMinFitTolerance. `looked_at`: added to, the number of points looked at.
std::vector<FittedPiece> fit_arcs(std::span<const Vec3> points, double tolerance, std::size_t* looked_at = nullptr);

}  // namespace riffler::nc
