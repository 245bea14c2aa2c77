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

/// Curves that separate places with less than `value`, on the curves' left, from the others: marching squares over
/// cells whose four places are all finite. `crossing(less, more)` returns the curve's point between two neighbouring
/// places; without it, the point is interpolated. `cells`: the cells to search, each given by its place with the
/// smallest column and row; none: all cells.
std::vector<Curve> contours(const PlaceGrid& grid, const Field& field, double value,
                            const std::function<Vec2(std::size_t less, std::size_t more)>& crossing = {},
                            const std::optional<std::span<const std::size_t>>& cells = {});

/// The curve without points that are less than `tolerance` (mm) from the line between their neighbours.
Curve simplified(const Curve& curve, double tolerance);

}  // namespace riffler::plan
