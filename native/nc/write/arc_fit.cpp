#include "nc/write/arc_fit.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "nc/write/arc_through.hpp"

namespace riffler::nc {

namespace {

/// The largest count in `least` … `most` for which `works`, assuming it is monotonic: doubles, then bisects, so that
/// the work is proportional to the answer. 0 if it does not work for `least`.
template <class Works>
std::size_t longest(std::size_t least, std::size_t most, const Works& works) {
  if (most < least || !works(least)) return 0;
  std::size_t good = least, bad = most + 1;
  while (good < most && bad > most) {
    const std::size_t next = std::min(2 * good, most);
    if (works(next))
      good = next;
    else
      bad = next;
  }
  while (bad <= most && bad - good > 1) {
    const std::size_t middle = good + (bad - good) / 2;
    (works(middle) ? good : bad) = middle;
  }
  return good;
}

class Fitter {
 public:
  Fitter(std::span<const Vec3> points, double tolerance)
      // Compensates for the slack added by kSamePoint.
      : points_(points), tolerance_(tolerance - 2 * kSamePoint) {}

  std::vector<FittedPiece> run() {
    std::vector<FittedPiece> pieces;
    for (std::size_t at = 0; at + 1 < points_.size(); at = pieces.back().last) pieces.push_back(piece_from(at));
    return pieces;
  }
  std::size_t looked_at = 0;

 private:
  /// Moves that a piece replaces; an arc if it goes further than a line.
  struct Reach {
    std::size_t line = 1, moves = 1;
    std::optional<PlaneArc> arc = {};
  };

  std::span<const Vec3> moves(std::size_t at, std::size_t count) const { return points_.subspan(at, count + 1); }

  /// Whether the line from first to last is within the tolerance of all points, and they never go back along it.
  bool line_fits(std::span<const Vec3> points) {
    const Vec3 way = points.back() - points.front();
    const double length = glm::length(way);
    const Vec3 along = length > 0 ? way / length : Vec3(0);
    const double tolerance = length > kSamePoint ? tolerance_ : kSamePoint;
    double furthest = 0;
    const auto beside = [&](const Vec3& p) {
      ++looked_at;
      const Vec3 off = p - points.front();
      const double ahead = glm::dot(off, along);
      if (!(ahead >= furthest - kSamePoint && ahead <= length + kSamePoint)) return false;
      if (glm::length(off - ahead * along) > tolerance) return false;
      furthest = std::max(furthest, ahead);
      return true;
    };
    for (std::size_t step = stride(points.size());; step = 1) {
      furthest = 0;
      for (std::size_t k = 0; k < points.size(); k += step)
        if (!beside(points[k])) return false;
      if (step == 1) return true;
    }
  }

  std::optional<PlaneArc> arc_over(std::size_t at, std::size_t count) {
    for (const Axis normal : {Axis::Z, Axis::Y, Axis::X})
      if (const auto arc = arc_within(moves(at, count), normal, tolerance_, looked_at)) return arc;
    return std::nullopt;
  }

  Reach reach_from(std::size_t at) {
    const std::size_t most = points_.size() - 1 - at;
    Reach reach;
    reach.line = reach.moves = longest(1, most, [&](std::size_t n) { return n == 1 || line_fits(moves(at, n)); });
    for (const Axis normal : {Axis::Z, Axis::Y, Axis::X}) {
      std::optional<PlaneArc> arc;
      const auto works = [&](std::size_t n) {
        const auto found = arc_within(moves(at, n), normal, tolerance_, looked_at);
        if (found) arc = found;  // the last one that fits is the longest
        return found.has_value();
      };
      const std::size_t n = longest(kMinArcMoves, most, works);
      if (n > reach.moves) reach.moves = n, reach.arc = arc;
    }
    return reach;
  }

  FittedPiece piece_from(std::size_t at) {
    const Reach reach = reach_from(at);
    if (reach.arc && !better_straight(at, reach)) return arc_piece(at, reach);
    return {at + reach.line, false, Axis::Z, Vec3(0), false};
  }

  /// A flat arc often extends a line before an arc a little further than a line does. If a line covers most of that
  /// distance and the next piece still reaches as far, prefers the line.
  bool better_straight(std::size_t at, const Reach& reach) {
    const std::size_t end = at + reach.moves;
    if (2 * reach.line < reach.moves || end + 1 >= points_.size()) return false;
    const std::size_t from = at + reach.line, count = end + reach_from(end).moves - from;
    return line_fits(moves(from, count)) || (count >= kMinArcMoves && arc_over(from, count));
  }

  FittedPiece arc_piece(std::size_t at, const Reach& reach) {
    const auto points = moves(at, reach.moves);
    const PlaneArc arc = nearest_arc(points, *reach.arc, tolerance_, looked_at);
    const double height = to_local(arc.normal, points.front()).z;
    const Vec3 centre = to_world(arc.normal, {arc.centre.x, arc.centre.y, height});
    return {at + reach.moves, true, arc.normal, centre, arc.sweep < 0};
  }

  std::span<const Vec3> points_;
  double tolerance_;
};

}  // namespace

std::vector<FittedPiece> fit_arcs(std::span<const Vec3> points, double tolerance, std::size_t* looked_at) {
  if (!(tolerance >= kMinFitTolerance) || !std::isfinite(tolerance))
    throw std::invalid_argument("tolerance must be finite and at least 0.00002 mm");
  for (std::size_t row = 0; row < points.size(); ++row)
    if (!geom::finite(points[row])) throw std::invalid_argument("points, row " + std::to_string(row) + ": not finite");
  Fitter fitter(points, tolerance);
  std::vector<FittedPiece> pieces = fitter.run();
  if (looked_at) *looked_at += fitter.looked_at;
  return pieces;
}

}  // namespace riffler::nc
