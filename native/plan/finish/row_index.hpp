// Finds the place on finished rows that is nearest to a tip.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "riffler/geom/vec.hpp"

namespace riffler::plan {

/// Straight pieces of rows in square bins, seen along the axis.
class RowIndex {
 public:
  /// `area`: box around all rows. `window`: largest distance, seen along the axis, at which places are found. Both mm.
  RowIndex(const Box3& area, double window);

  void add(const std::vector<Vec3>& tips);
  /// The nearest place on a row; none if no row is within the window.
  std::optional<Vec3> nearest(const Vec3& p) const;
  /// Whether `holds(from, to)` is true for any straight piece within the window of `p`, and possibly for others.
  template <class Holds>
  bool any(const Vec3& p, const Holds& holds) const {
    const std::size_t middle = bin(p.x, p.y), column = middle % columns_, row = middle / columns_;
    for (std::size_t r = row > 0 ? row - 1 : 0; r <= std::min(row + 1, rows_ - 1); ++r)
      for (std::size_t c = column > 0 ? column - 1 : 0; c <= std::min(column + 1, columns_ - 1); ++c)
        for (const std::uint32_t k : bins_[r * columns_ + c])
          if (holds(from_[k], to_[k])) return true;
    return false;
  }

 private:
  std::size_t bin(double x, double y) const;

  Vec2 lower_;
  double window_, size_;
  std::size_t columns_, rows_;
  std::vector<Vec3> from_, to_;
  std::vector<std::vector<std::uint32_t>> bins_;
};

}  // namespace riffler::plan
