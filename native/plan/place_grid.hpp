// Places seen along the tool's axis, in a square grid, and distances between sets of them.
#pragma once

#include <cstddef>
#include <vector>

#include "riffler/geom/vec.hpp"

namespace riffler::plan {

/// A square grid of places. Coordinates in the rows' frame, mm.
struct PlaceGrid {
  Vec2 lower{0};
  double spacing = 1;
  int columns = 0, rows = 0;  ///< number of places along x and y

  std::size_t size() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
  }
  Vec2 place(std::size_t k) const {
    const auto n = static_cast<std::size_t>(columns);
    return lower + spacing * Vec2(static_cast<double>(k % n), static_cast<double>(k / n));
  }
  /// The nearest place of the grid.
  std::size_t nearest(const Vec2& p) const;
};

/// A number for each place.
using Field = std::vector<double>;
/// A set of places: not 0 for its members.
using PlaceSet = std::vector<char>;

/// Distance (mm) of each place from the nearest place of a set; infinite if the set is empty. Exact: lower envelopes of
/// parabolas along rows, then along columns (Felzenszwalb and Huttenlocher, Theory of Computing 8 (2012) 415).
Field distance_to(const PlaceGrid& grid, const PlaceSet& set);

/// The set without parts thinner than `width` (mm), unless they border on thicker parts.
PlaceSet without_slivers(const PlaceGrid& grid, const PlaceSet& set, double width);

/// Length (mm) of the shortest path within `in` from one of the places `from` to each place; infinite if there is no
/// path. Solves the eikonal equation by fast marching of first order (Sethian, PNAS 93 (1996) 1591).
Field path_lengths(const PlaceGrid& grid, const PlaceSet& in, const PlaceSet& from);

/// Adds the lengths of paths from the places `from` to `lengths`, in areas where these are still infinite.
void add_path_lengths(const PlaceGrid& grid, const PlaceSet& in, const std::vector<std::size_t>& from, Field& lengths);

}  // namespace riffler::plan
