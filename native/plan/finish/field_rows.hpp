// Rows on which a field over a grid of places has one value each, and further ones wherever two of them leave too much.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "plan/contours.hpp"
#include "plan/finish/patterns.hpp"

namespace riffler::plan {

/// A field, and how rows are made of it.
struct RowField {
  const PlaceGrid& grid;
  const Field& values;
  std::vector<double> first;       ///< values of the first rows, ascending
  double finest;                   ///< rows are not nearer to each other, in units of the field
  double least_slope, most_slope;  ///< rad: flatter and steeper faces are not meant
  double lift;                     ///< mm by which rows lie outside of the drop surface
  const char* flat;                ///< what to say of those, or null
  /// The row of a value: all of it, or what is near the places of a set.
  std::function<std::vector<CutPiece>(double value, const PlaceSet* near, std::vector<BlockedPlace>& blocked)> row;
  /// The point of the surface between two neighbouring places where the field has a value; none at a step.
  std::function<std::optional<SurfacePoint>(std::size_t a, std::size_t b, double value)> between;
};

/// The rows of `first`, and between two of them, in halves, what is needed so that ridges are not higher than the cusp.
/// Judged at places of the grid, and half way between rows.
PatternRows field_rows(const PatternScene& scene, const RowField& field, const Progress& progress);

}  // namespace riffler::plan
