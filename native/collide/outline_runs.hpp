// The outline of a tool in stretches along which it turns one way only, and what they say of the distance near a point.
//
// Let C be the solid that a run bounds, closed by level discs at its ends. The tool is the union of these solids, so
// outside of it the distance is the least of theirs, and each of those is convex where the run has no hollow: tangent
// planes bound it from below everywhere. Inside, the depth is the distance from the *outer* surface, which in C is at
// most that from the run itself. Let K ⊇ C be the convex solid under the run and the tangents that go on from its ends,
// with signed distance f_K. Points of C whose foot on K is not on those tangents have depth ≤ −f_K, and f_K is convex:
// again a plane bounds the distance from below, and near an inner corner of the tool, where two steps of the run are
// equally near, two planes do.
//
// A hollow is a run by itself, an arc of the circle about c with radius R, and C lies outside of that circle. Points q
// of C in the arc's sector have depth ≤ |q − c| − R, the distance from the arc, so R − |q − c| bounds the distance from
// below; and so it does for points outside of C, by the ball about c that does not enter it. Neither asks where the
// bound is taken from, so one ball serves points of a cell that are in C and those that are not. The level discs do
// not: where the tool goes on behind them, points of C are deeper than these are near.
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

  /// Signed distance at a point and in which direction it grows.
  struct Slope {
    double distance;
    Vec2 normal;
    double curvature = 0;  ///< of the line of equal distance through the point, in the half-plane; 0 where hollow
    /// Radius of a ball that touches the foot and does not enter the solid; ∞: a half-space.
    double reach = std::numeric_limits<double>::infinity();
  };
  /// What one run is to a point of the half-plane.
  struct RunAt {
    bool inside, hollow;          ///< inside of C
    Slope closed;                 ///< to C; only for points outside
    std::array<Slope, 2> behind;  ///< to K: at the point's foot, and the next nearest step (twice the same: none);
                                  ///< of a hollow, R − |q − c|
    double from_run;              ///< distance from the edges
    Slope facing;   ///< to the nearest of the straight steps that have the point's foot between their ends
    double margin;  ///< how far the foot is from these ends
  };
  /// Signed distance from the whole tool.
  struct At : Slope {
    Vec2 foot;
    tool::Part part;
    std::size_t run;
    double margin;  ///< all points nearer to p than this have their feet on the edge that p's foot is on; −1: at an end
    bool outermost;  ///< that edge is straight, and all of the tool is on one side of it
    Slope second;    ///< inside, to the next nearest edge that lies in another direction; −∞ where there is none
  };

  struct End {
    Vec2 point, way, normal;  ///< of the tangent that goes on from there, and out of the solid
    bool open;                ///< not on the axis
  };
  struct Run {
    std::size_t first, last;  ///< edges
    double reach;  ///< radius of the largest ball that rolls along it from outside: infinity, or that of a hollow
    End lower, upper;
  };
  const std::vector<Run>& all() const { return runs_; }
  std::size_t size() const { return runs_.size(); }
  /// Fills `runs`, which has room for size().
  At at(const Vec2& p, RunAt* runs) const;

  /// Whether all points within `radius` of p, at which the run is `at`, have feet on K that are on the run, not on the
  /// tangents at its ends: they lie behind the end, or the run is nearer. Of a hollow: whether they are in its sector.
  bool behind_ends(std::size_t run, const RunAt& at, const Vec2& p, double radius) const {
    const auto passes = [&](const End& e) {
      return !e.open || glm::dot(p - e.point, e.way) + radius <= 0 ||
             glm::dot(p - e.point, e.normal) + at.from_run + 2 * radius <= 0;
    };
    return passes(runs_[run].lower) && passes(runs_[run].upper);
  }

  /// Whether a point is in the sector of a hollow, for any distance from the axis between these; to rounding.
  bool in_sector(std::size_t run, double rho, double least_rho, double z) const {
    const auto passes = [&](const End& e) {
      const Vec2 p(e.way.x > 0 ? rho : least_rho, z);
      return !e.open || glm::dot(p - e.point, e.way) <= 1e-13 * (1 + std::abs(rho) + std::abs(z));
    };
    return passes(runs_[run].lower) && passes(runs_[run].upper);
  }

 private:
  struct Foot;

  double reach_at(const Run& run, const Slope& closed, const Vec2& foot) const;
  bool holds(const Run& run, const Vec2& p) const;
  Foot foot_on(const tool::OutlineEdge& e, const Vec2& p) const;
  void look(const Run& run, const Vec2& p, RunAt& out, Foot& nearest, Foot& second) const;
  bool all_behind(const tool::OutlineEdge& e) const;

  std::vector<tool::OutlineEdge> edges_;
  std::vector<char> outermost_;  // of the edges
  std::vector<Run> runs_;
};

}  // namespace riffler::collide
