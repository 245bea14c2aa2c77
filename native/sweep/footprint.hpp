// Finds the rays that a step of a tool can touch, and at which heights.
#pragma once

#include <initializer_list>
#include <span>

#include "riffler/base/block_pool.hpp"
#include "riffler/dexel/tile.hpp"
#include "riffler/geom/interval.hpp"
#include "riffler/geom/pose.hpp"
#include "riffler/tool/piece.hpp"
#include "sweep/convex_group.hpp"

namespace riffler::sweep {

/// For each piece, the convex hull of its axis at the given poses, thickened by its largest radius and projected along
/// the rays (third coordinate of the cyclic frame). Or the convex hull of points, projected.
class Footprint {
 public:
  /// At most two poses. `slack`: distance by which the motion between them may leave the hull, mm.
  Footprint(std::span<const tool::Piece> pieces, std::initializer_list<Pose> poses, double slack);
  /// The convex hull of points, at most `slack` mm wider.
  Footprint(std::span<const Vec3> points, double slack);

  /// Ranges of u, v and the third coordinate (not always tight).
  const Interval& rows() const { return rows_; }
  const Interval& columns() const { return columns_; }
  const Interval& height() const { return height_; }
  /// Ranges of v among the rays at each of n ≤ kTileSide values of u.
  struct Rows {
    double near[dexel::kTileSide], far[dexel::kTileSide];
  };
  void rows(const double* u, int n, Rows& out) const;
  bool overlaps(const Box3& box) const;

 private:
  /// The outline: discs of one radius at the corners, and the long sides of the strips between them, v = y + slope (u −
  /// x) from `from` to `to`.
  struct Side {
    double from, to, x, y, slope;
  };
  struct Hull {
    double thickness = 0;
    int corners = 0, sides = 0;
    Vec2 corner[4];
    Side side[12];
  };
  static void add_corner(Hull& hull, const Vec2& p);
  static void add_sides(Hull& hull);
  void add_chain(std::span<const Vec2> sorted, double side);
  void polygon_rows(const double* u, int n, Rows& out) const;

  std::size_t count_ = 0;
  Hull hulls_[ConvexGroup::kMax];
  Interval rows_, columns_, height_;
  /// Sides of the hull of points: first those below, then those above.
  base::BlockVector<Side> polygon_;
  std::size_t below_ = 0;
  double slack_ = 0;
};

}  // namespace riffler::sweep
