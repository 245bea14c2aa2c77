// Places seen along the tool's axis, in a square grid, and distances between sets of them.
#pragma once

#include <cstddef>
#include <vector>

#include "riffler/geom/vec.hpp"

namespace riffler::plan {

/// Coordinates are those of the rows' frame, mm.
struct PlaceGrid {
  Vec2 lower{0};
  double spacing = 1;
  int columns = 0, rows = 0;  ///< along x and y

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

/// A number for each place, and a set of places.
using Field = std::vector<double>;
using PlaceSet = std::vector<char>;

/// Distance (mm) of each place from the nearest one of a set; infinite if that is empty. Exact: parabolas of rows, then
/// of columns (Felzenszwalb and Huttenlocher, Theory of Computing 8 (2012) 415).
Field distance_to(const PlaceGrid& grid, const PlaceSet& set);

/// A set without what is thinner than `width` (mm), unless it borders on something thicker.
PlaceSet without_slivers(const PlaceGrid& grid, const PlaceSet& set, double width);

/// Length of the shortest path within `in` from one of the places `from` to each place; infinite where none leads. The
/// eikonal equation by fast marching, of first order (Sethian, PNAS 93 (1996) 1591).
Field path_lengths(const PlaceGrid& grid, const PlaceSet& in, const PlaceSet& from);

/// Puts such lengths from the places `from` into `lengths`, where these are infinite so far: areas that no path led to.
void add_path_lengths(const PlaceGrid& grid, const PlaceSet& in, const std::vector<std::size_t>& from, Field& lengths);

}  // namespace riffler::plan
