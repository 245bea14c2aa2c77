// Smallest signed distance between a tool and a triangle.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "collide/deadline.hpp"
#include "collide/drift.hpp"
#include "collide/outline_runs.hpp"
#include "collide/tool_frame.hpp"
#include "nurbs/exact_triangles.hpp"
#include "nurbs/excess.hpp"
#include "riffler/base/block_pool.hpp"
#include "riffler/geom/vec.hpp"

namespace riffler::collide {

/// A triangle's corners in the tool's frame.
struct Corners {
  Vec3 a, b, c;
};

/// A part of an exact surface, and the chord below it.
struct ExactPiece {
  const nurbs::ExactTriangles& surface;
  const ToolFrame& frame;
  const nurbs::ExactTriangle& triangle;
  Corners chord;  // in the tool's frame
};

/// Largest distance of a triangle's points from a point.
inline double farthest(const Corners& t, const Vec3& p) {
  const auto square = [&](const Vec3& q) { return glm::dot(q - p, q - p); };
  return std::sqrt(std::max({square(t.a), square(t.b), square(t.c)}));
}

/// Branch and bound, exact up to rounding. Descends to the minimum of the distance on a cell; then the tangent planes
/// of the tool's runs (outline_runs.hpp) prove that nothing is lower, or the cell is halved. Keeps the minimum over all
/// triangles so far, so that later ones finish sooner.
class TriangleSearch {
 public:
  struct Least {
    double distance = std::numeric_limits<double>::infinity();
    Vec3 point{0};  ///< in the tool's frame, mm
    tool::Part part = tool::Part::Cutter;
  };

  /// Keeps a reference to `runs`.
  explicit TriangleSearch(const OutlineRuns& runs) : runs_(runs), at_(runs.size()) {}

  const Least& least() const { return least_; }
  /// Smallest improvement of the minimum that is worth searching for: 1e-10 mm plus the rounding of coordinates up to
  /// `size` (mm).
  static double slack(double size) { return 1e-10 + 1e-15 * size; }

  /// A lower bound over the triangle from one evaluation at its centre, which may also lower the minimum.
  double bound(const Corners& t);
  /// The same for all times of an interval, from a few evaluations at its middle, which may lower the minimum.
  double bound(const Corners& t, const Drift& drift);
  /// Evaluates at a place of a triangle, which may lower the minimum.
  void visit(const Vec3& place) { look(place); }
  /// `low`: a known lower bound on the triangle. Stops at the deadline.
  void search(const Corners& t, double low, Deadline& deadline);
  /// The exact surface above the place of a chord that is nearest to `place` (in the tool's frame).
  void visit(const ExactPiece& piece, const Vec3& place);
  /// The same for a part of an exact surface, to kExact: chords bound it from below, and become shorter.
  void search(const ExactPiece& piece, double low, Deadline& deadline);
  static constexpr double kExact = 5e-7;  // mm
  /// Allows a search to stop at the first place nearer than `distance` (mm).
  void enough(double distance) { enough_ = distance; }
  /// Starts with a minimum of `distance` (mm), at no place.
  void below(double distance) { least_.distance = distance; }
  /// Allows the search to miss places that are lower by less than `by` (mm).
  void loose(double by) { loose_ = by; }

  /// Lower bound over all triangles: the minimum. Up to kLeftOut less if a triangle took kMaxCells, as happens deep
  /// inside a tool where three of its surfaces are equally near; still less if the time ran out or a triangle took
  /// kMostCells.
  double low() const { return std::min(left_, least_.distance); }
  static constexpr std::size_t kMaxCells = 50'000, kMostCells = 20 * kMaxCells;
  static constexpr double kLeftOut = 1e-3;  // mm

  std::size_t cells() const { return cells_; }

  /// Resets the minimum for an independent triangle.
  void forget() { least_ = {}, left_ = std::numeric_limits<double>::infinity(); }

 private:
  /// An evaluation at a point: the distance there, in space.
  struct Look {
    Vec3 point, radial;  // radial: 0 on the axis, where the mean over planes of all directions is used
    Vec2 place;
    OutlineRuns::At at;

    /// A direction away from the axis; on the axis, where a foot or ball needs one direction, an arbitrary one.
    Vec3 out() const { return radial == Vec3(0) ? Vec3(1, 0, 0) : radial; }
  };

  struct Cell {
    Corners t;
    double low;
    bool operator<(const Cell& o) const { return low > o.low; }
  };

  /// A triangle of parameters in a cell of an exact surface.
  struct ExactCell {
    Corners t;
    Vec2 uv[3];
    double low;
    bool by_chord;  // the chord leaves the bound open, not the tool's shape
    bool operator<(const ExactCell& o) const { return low > o.low; }
  };

  Look look(const Vec3& p);
  void bound(const ExactPiece& piece, ExactCell& cell, double near);
  bool proven(const ExactPiece& piece, const ExactCell& cell, const Look& from, const Vec2& uv, double near);
  bool halve(const ExactPiece& piece, const ExactCell& cell);
  Look look_beside(const Vec3& p);  // evaluates a place off the triangle
  bool in_sector(std::size_t run, const Corners& t, const Look& from) const;
  double lower(const Corners& t, const Look& from) const;
  std::array<double, 3> plane(const OutlineRuns::Slope& s, const Corners& t, const Look& from) const;
  std::array<double, 3> ball(const OutlineRuns::Slope& s, const Corners& t, const Look& from) const;
  std::array<double, 3> outer(const Corners& t, const Look& from, double radius) const;
  double solid_bound(std::size_t run, const Corners& t, const Look& from, double radius) const;
  double by_facing(const OutlineRuns::RunAt& at, const Corners& t, const Look& from, double radius,
                   const std::array<double, 3>& outer) const;
  double by_zones(std::size_t run, const Corners& t, const Look& from) const;
  double run_bound(std::size_t run, const Corners& t, const Look& from, double radius,
                   const std::array<double, 3>& outer) const;
  Look downhill(const Corners& t, Look from);

  void push(const Cell& cell);
  bool halve(const Corners& cell, double low);

  double drift_of(const Vec3& p) const { return drift_ ? drift_->most(glm::length(p)) : 0; }

  const OutlineRuns& runs_;
  const Drift* drift_ = nullptr;              // allowed for by the bounds; may be null
  base::BlockVector<OutlineRuns::RunAt> at_;  // from the last evaluation
  Least least_;
  base::BlockVector<Cell> heap_;
  base::BlockVector<ExactCell> exact_heap_;
  nurbs::Excess excess_;
  bool on_chord_ = false;  // look() gets points of the chord, not of the surface
  std::size_t cells_ = 0;
  double loose_ = 0;
  double left_ = std::numeric_limits<double>::infinity(), enough_ = -left_;
};

}  // namespace riffler::collide
