// Finds the place on finished rows that is nearest to a tip.
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
  /// `area`: box around all rows. `window`: largest distance, seen along the axis, at which places are found. Both mm.
  RowIndex(const Box3& area, double window);

  void add(const std::vector<Vec3>& tips);
  /// The nearest place on a row; none if no row is within the window.
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
