// Curves on which a field over a grid of places has one value.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "plan/place_grid.hpp"

namespace riffler::plan {

/// A curve; the first point of a closed one is not repeated.
struct Curve {
  std::vector<Vec2> points;
  bool closed = false;
};

/// Curves between places with less than `value`, on their left, and the others: marching squares over cells whose four
/// places are all finite. `crossing(a, b)` gives the point between two neighbouring places, less first; without it, it
/// is interpolated. `cells`: the only ones to look at, each by its place of lower column and row; all without it.
std::vector<Curve> contours(const PlaceGrid& grid, const Field& field, double value,
                            const std::function<Vec2(std::size_t less, std::size_t more)>& crossing = {},
                            const std::optional<std::span<const std::size_t>>& cells = {});

/// The curve without points that are less than `tolerance` (mm) off the line between others.
Curve simplified(const Curve& curve, double tolerance);

}  // namespace riffler::plan
