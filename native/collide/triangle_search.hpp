// The least signed distance between a tool and a triangle.
#pragma once

#include <array>
#include <limits>

#include "collide/deadline.hpp"
#include "collide/drift.hpp"
#include "collide/outline_runs.hpp"
#include "riffler/base/block_pool.hpp"
#include "riffler/geom/vec.hpp"

namespace riffler::collide {

/// In the tool's frame.
struct Corners {
  Vec3 a, b, c;
};

/// Branch and bound, exact to rounding: the distance is followed downhill to its least place on a cell, where the
/// tangent planes of the tool's runs (outline_runs.hpp) prove that nothing is lower, or the cell is halved. Keeps the
/// least of all triangles seen, so that later ones are done sooner.
class TriangleSearch {
 public:
  struct Least {
    double distance = std::numeric_limits<double>::infinity();
    Vec3 point{0};  ///< in the tool's frame
    tool::Part part = tool::Part::Cutter;
  };

  /// Refers to `runs`.
  explicit TriangleSearch(const OutlineRuns& runs) : runs_(runs), at_(runs.size()) {}

  const Least& least() const { return least_; }
  /// What a lower place must be below the least to be looked for: 1e-10 mm, or rounding in coordinates of this size.
  static double slack(double size) { return 1e-10 + 1e-15 * size; }

  /// A lower bound over the triangle from one look at its middle, which may lower the least.
  double bound(const Corners& t);
  /// The same for all times of a stretch, looked at in its middle: a few looks, which may lower the least.
  double bound(const Corners& t, const Drift& drift);
  /// `low`: no place on the triangle is known to be lower. Stops at the deadline.
  void search(const Corners& t, double low, Deadline& deadline);
  /// A search may end at a place with less than this, without proof that it is the least.
  void enough(double distance) { enough_ = distance; }
  /// Places that are lower by less than this need not be found, mm.
  void loose(double by) { loose_ = by; }

  /// No place on any triangle is lower than this: the least, or less where kMaxCells or the time did not suffice. The
  /// first happens deep in a tool where three of its surfaces are equally near.
  double low() const { return std::min(left_, least_.distance); }
  static constexpr std::size_t kMaxCells = 50000;

  std::size_t cells() const { return cells_; }

  /// For another triangle by itself.
  void forget() { least_ = {}, left_ = std::numeric_limits<double>::infinity(); }

 private:
  /// A look at a point: the distance there, in space.
  struct Look {
    Vec3 point, radial;  // radial: 0 on the axis, where planes of all directions together are the mean of theirs
    Vec2 place;
    OutlineRuns::At at;

    /// A direction out from the axis: on it, where a foot or a ball must be at one place, any.
    Vec3 out() const { return radial == Vec3(0) ? Vec3(1, 0, 0) : radial; }
  };

  struct Cell {
    Corners t;
    double low;
    bool operator<(const Cell& o) const { return low > o.low; }
  };

  Look look(const Vec3& p);
  Look look_beside(const Vec3& p);  // a place that is not on the triangle
  bool in_sector(std::size_t run, const Corners& t, const Look& from) const;
  double lower(const Corners& t, const Look& from) const;
  std::array<double, 3> plane(const OutlineRuns::Slope& s, const Corners& t, const Look& from) const;
  std::array<double, 3> ball(const OutlineRuns::Slope& s, const Corners& t, const Look& from) const;
  std::array<double, 3> outer(const Corners& t, const Look& from, double radius) const;
  double run_bound(std::size_t run, const Corners& t, const Look& from, double radius,
                   const std::array<double, 3>& outer) const;
  Look downhill(const Corners& t, Look from);

  void push(const Cell& cell);
  bool halve(const Corners& cell, double low);

  double drift_of(const Vec3& p) const { return drift_ ? drift_->most(glm::length(p)) : 0; }

  const OutlineRuns& runs_;
  const Drift* drift_ = nullptr;              // that bounds are to allow for
  base::BlockVector<OutlineRuns::RunAt> at_;  // of the last look
  Least least_;
  base::BlockVector<Cell> heap_;
  std::size_t cells_ = 0;
  double loose_ = 0;
  double left_ = std::numeric_limits<double>::infinity(), enough_ = -left_;
};

}  // namespace riffler::collide
