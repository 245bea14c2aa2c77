// Splits a tool's outline into runs that turn one way only, and derives distance bounds near a point from them.
//
// Let C be the solid bounded by a run and closed by horizontal discs at its ends. The tool is the union of these
// solids, so outside the tool its distance is the smallest of theirs. If the run has no hollow, C is convex, and
// tangent planes bound the distance from below everywhere. Inside, depth is the distance from the *outer* surface,
// which in C is at most the distance from the run itself. Let K ⊇ C be the convex solid under the run and the tangents
// that extend it beyond its ends, with signed distance f_K. Points of C whose foot on K is not on those tangents have
// depth ≤ −f_K, and f_K is convex: again a plane bounds the distance from below. Near an inner corner of the tool,
// where two edges of the run are equally near, two planes do.
//
// A hollow is a run by itself: an arc of the circle about c with radius R, with C outside that circle. Points q of C in
// the arc's sector have depth ≤ |q − c| − R, the distance from the arc, so R − |q − c| bounds the signed distance from
// below. It also does for points outside C, because the ball about c does not enter C. The bound is the same in both
// cases, so one ball serves points of a cell inside and outside C. The horizontal discs do not bound the depth: where
// the tool continues behind them, points of C are deeper than their distance from a disc.
#pragma once

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "riffler/tool/outline.hpp"

namespace riffler::collide {

class OutlineRuns {
 public:
  explicit OutlineRuns(std::vector<tool::OutlineEdge> edges);

  /// Signed distance at a point and the direction in which it grows.
  struct Slope {
    double distance;
    Vec2 normal;
    double curvature = 0;  ///< 1/mm, of the distance's level line in the half-plane; 0 for a hollow
    /// Radius (mm) of a ball that touches the foot without entering the solid; ∞: a half-space.
    double reach = std::numeric_limits<double>::infinity();
  };
  /// Relation of one run to a point of the half-plane.
  struct RunAt {
    bool inside, hollow;          ///< the point is inside C; the run is a hollow
    Slope closed;                 ///< distance to C; only for points outside
    std::array<Slope, 2> behind;  ///< distance to K: at the point's foot, and at the next nearest edge (twice the same:
                                  ///< none); for a hollow, R − |q − c|
    double from_run;              ///< distance from the run's edges, mm
    /// Distance to the nearest straight edge that has the point's foot between its ends, and to the next nearest in
    /// another direction (−∞: none).
    std::array<Slope, 2> facing;
    std::array<double, 2> margin;  ///< distance of the feet from those ends, mm; −1: none
  };
  /// Signed distance from the whole tool.
  struct At : Slope {
    Vec2 foot;
    tool::Part part;
    std::size_t run;
    double margin;   ///< mm: points nearer to p than this have their feet on the same edge as p; −1: at an end
    bool outermost;  ///< the edge is straight and the whole tool lies on one side of it
    Slope second;    ///< inside: distance to the next nearest edge in another direction; −∞: none
  };

  struct End {
    Vec2 point, way, normal;  ///< end point, direction of the tangent beyond it, normal out of the solid
    bool open;                ///< the end is not on the axis
    bool narrow;              ///< open, and points of the run's solid may have feet beyond it, or for a hollow, any
  };
  struct Run {
    std::size_t first, last;  ///< indices of its edges
    double reach;             ///< mm: radius of the largest ball that rolls along it outside: infinity, or the hollow's
    End lower, upper;
  };
  const std::vector<Run>& all() const { return runs_; }
  std::size_t size() const { return runs_.size(); }
  /// Relation of every run to point p. Fills `runs`, which has room for size() entries.
  At at(const Vec2& p, RunAt* runs) const;

  /// Whether all points within `radius` of p, at which the run is `at`, have feet on K that are on the run, not on the
  /// tangents at its ends: because they lie behind the end, or because the run is nearer. For a hollow: whether they
  /// are in its sector.
  bool behind_ends(std::size_t run, const RunAt& at, const Vec2& p, double radius) const {
    const auto passes = [&](const End& e) {
      return !e.narrow || glm::dot(p - e.point, e.way) + radius <= 0 ||
             glm::dot(p - e.point, e.normal) + at.from_run + 2 * radius <= 0;
    };
    return passes(runs_[run].lower) && passes(runs_[run].upper);
  }

  /// Lower bound of −depth for the points of a convex run's solid C whose feet on K lie beyond an end, among points at
  /// least `low_rho` from the axis and at heights from `low_z` to `high_z`; ∞ if there are none. Such a point is at
  /// most as deep as the end's edge is far. Its feet lie beyond an end only where the run becomes narrower towards it.
  double beyond_ends(std::size_t run, double low_rho, double low_z, double high_z) const;

  /// Whether a point lies in the sector of a hollow for every distance from the axis between `least_rho` and `rho`, up
  /// to rounding.
  bool in_sector(std::size_t run, double rho, double least_rho, double z) const {
    const auto passes = [&](const End& e) {
      const Vec2 p(e.way.x > 0 ? rho : least_rho, z);
      return !e.narrow || glm::dot(p - e.point, e.way) <= 1e-13 * (1 + std::abs(rho) + std::abs(z));
    };
    return passes(runs_[run].lower) && passes(runs_[run].upper);
  }

 private:
  struct Foot;

  static void add_facing(const Slope& slope, double margin, RunAt& out);
  double reach_at(const Run& run, const Slope& closed, const Vec2& foot) const;
  bool holds(const Run& run, const Vec2& p) const;
  Foot foot_on(const tool::OutlineEdge& e, const Vec2& p) const;
  void look(const Run& run, const Vec2& p, RunAt& out, Foot& nearest, Foot& second) const;
  bool all_behind(const tool::OutlineEdge& e) const;

  std::vector<tool::OutlineEdge> edges_;
  std::vector<char> outermost_;  // per edge
  std::vector<Run> runs_;
};

}  // namespace riffler::collide
