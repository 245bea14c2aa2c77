// The outline of a tool in stretches along which it turns one way only, and what they say of the distance near a point.
//
// Let C be the solid that a run bounds, closed by level discs at its ends. The tool is the union of these solids, so
// outside of it the distance is the least of theirs, and each of those is convex where the run has no hollow: tangent
// planes bound it from below everywhere. Inside, the depth is the distance from the *outer* surface, which in C is at
// most that from the run itself. Let K ⊇ C be the convex solid under the run and the tangents that go on from its ends,
// with signed distance f_K. Points of C whose foot on K is not on those tangents have depth ≤ −f_K, and f_K is convex:
// again a plane bounds the distance from below, and near an inner corner of the tool, where two steps of the run are
// equally near, two planes do.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "tool/outline.hpp"

namespace riffler {

class OutlineRuns {
 public:
  explicit OutlineRuns(std::vector<OutlineEdge> edges);

  /// Signed distance at a point and in which direction it grows.
  struct Slope {
    double distance;
    Vec2 normal;
    double curvature = 0;  ///< of the line of equal distance through the point, in the half-plane; 0 where hollow
  };
  /// What one run is to a point of the half-plane.
  struct RunAt {
    bool inside;                  ///< of C
    Slope closed;                 ///< to C; only for points outside
    std::array<Slope, 2> behind;  ///< to K: at the point's foot, and the next nearest step (twice the same: none)
    double from_run;              ///< distance from the edges
    double reach;   ///< radius of a ball that touches C at the foot and does not enter it; ∞: a half-space
    Slope facing;   ///< to the nearest of the straight steps that have the point's foot between their ends
    double margin;  ///< how far the foot is from these ends
  };
  /// Signed distance from the whole tool.
  struct At : Slope {
    Vec2 foot;
    Part part;
    std::size_t run;
  };

  std::size_t size() const { return runs_.size(); }
  /// Fills `runs`, which has room for size().
  At at(const Vec2& p, RunAt* runs) const;

  /// Whether all points within `radius` of p, at which the run is `at`, have feet on K that are on the run, not on the
  /// tangents at its ends: they lie behind the end, or the run is nearer.
  bool behind_ends(std::size_t run, const RunAt& at, const Vec2& p, double radius) const {
    const auto passes = [&](const End& e) {
      return !e.open || glm::dot(p - e.point, e.way) + radius <= 0 ||
             glm::dot(p - e.point, e.normal) + at.from_run + 2 * radius <= 0;
    };
    return passes(runs_[run].lower) && passes(runs_[run].upper);
  }

 private:
  struct End {
    Vec2 point, way, normal;  // of the tangent that goes on from there, and out of the solid
    bool open;                // not on the axis
  };
  struct Run {
    std::size_t first, last;  // edges
    double reach;  // radius of the largest ball that rolls along it from outside: infinity, or that of a hollow
    End lower, upper;
  };
  struct Foot;

  double reach_at(const Run& run, const Slope& closed, const Vec2& foot) const;
  bool holds(const Run& run, const Vec2& p) const;
  Foot foot_on(const OutlineEdge& e, const Vec2& p) const;
  void look(const Run& run, const Vec2& p, RunAt& out, Foot& nearest) const;

  std::vector<OutlineEdge> edges_;
  std::vector<Run> runs_;
};

}  // namespace riffler
