// Which rays a step of a piece can touch, and at which heights.
#pragma once

#include <initializer_list>
#include <vector>

#include "geom/interval.hpp"
#include "geom/pose.hpp"
#include "tool/piece.hpp"

namespace riffler {

/// The convex hull of a piece's axis at some poses, thickened by the piece's largest radius, seen along the rays (third
/// coordinate of the cyclic frame).
class Footprint {
 public:
  /// `slack`: how far the motion between the poses may leave the hull, mm.
  Footprint(const Piece& piece, std::initializer_list<Pose> poses, double slack);

  /// Ranges of u, of v and of the third coordinate (not always tight).
  const Interval& rows() const { return rows_; }
  const Interval& columns() const { return columns_; }
  const Interval& height() const { return height_; }
  /// Range of v among the rays at u.
  Interval row(double u) const;
  bool overlaps(const Box3& box) const;

 private:
  static constexpr int kMost = 4;
  int count_ = 0;
  Vec2 corner_[kMost];
  double thickness_;
  Interval rows_, columns_, height_;
};

}  // namespace riffler
