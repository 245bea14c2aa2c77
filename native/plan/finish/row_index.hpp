// Finds the place of finished rows that is nearest to a tip.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "riffler/geom/vec.hpp"

namespace riffler::plan {

/// Straight pieces of rows in square bins, seen along the axis.
class RowIndex {
 public:
  /// `area`: of all rows, mm; `window`: how far away, seen along the axis, places count.
  RowIndex(const Box3& area, double window);

  void add(const std::vector<Vec3>& tips);
  /// The nearest place of a row; none within the window.
  std::optional<Vec3> nearest(const Vec3& p) const;

 private:
  std::size_t bin(double x, double y) const;

  Vec2 lower_;
  double window_, size_;
  std::size_t columns_, rows_;
  std::vector<Vec3> from_, to_;
  std::vector<std::vector<std::uint32_t>> bins_;
};

}  // namespace riffler::plan
