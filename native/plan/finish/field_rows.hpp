// Rows along which a field over a grid has one value, with further rows wherever two rows leave too much material.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "plan/contours.hpp"
#include "plan/finish/patterns.hpp"

namespace riffler::plan {

/// A field over a grid, and functions that make rows of it.
struct RowField {
  const PlaceGrid& grid;
  const Field& values;
  std::vector<double> first;       ///< values of the first rows, ascending
  double finest;                   ///< smallest difference between the values of two rows
  double least_slope, most_slope;  ///< rad: flatter and steeper faces are left to other patterns
  double lift;                     ///< distance by which rows lie outside of the drop surface, mm
  const char* flat;                ///< reason reported for flatter faces that are selected; null: none
  /// Makes the row of a value: the whole row, or its parts near the places of a set.
  std::function<std::vector<CutPiece>(double value, const PlaceSet* near, std::vector<BlockedPlace>& blocked)> row;
  /// Finds the surface's point between two neighbouring places at which the field has a value; none at a step.
  std::function<std::optional<SurfacePoint>(std::size_t a, std::size_t b, double value)> between;
  /// Finds the lowest point at which the cutter touches a wall between two neighbouring places that reaches a value;
  /// none if there is no step. May be empty.
  std::function<std::optional<SurfacePoint>(std::size_t a, std::size_t b, double value)> foot = {};
};

/// Makes the rows of `first`, then halves the interval between two rows as long as ridges between them are higher than
/// the cusp. Ridges are measured at the grid's places and half way between rows.
PatternRows field_rows(const PatternScene& scene, const RowField& field, const Progress& progress);

}  // namespace riffler::plan
