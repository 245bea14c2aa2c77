// Entries: how the cutter comes down into a layer that has no open side.
#pragma once

#include <vector>

#include "plan/place_grid.hpp"

namespace riffler::plan {

/// A helix around the only point of `path` or, if `radius` is 0, a ramp to and fro along `path`.
struct Entry {
  std::vector<Vec2> path;
  double radius = 0;  ///< radius of the helix, mm; 0: a ramp
};

/// Tips from height `top` down to `z`, nowhere steeper than `slope` (rad). The last tip is the helix's point in
/// direction x, or the beginning of the ramp.
std::vector<Vec3> way_down(const Entry& entry, double top, double z, double slope);
/// Tips at height `z` that remove the slanted rest of the entry: once round the helix and to its middle, or to the
/// ramp's end.
std::vector<Vec3> level_way(const Entry& entry, double z);

/// A line of at most `length` (mm) within the places `in`, from `start` to a place as far away as possible.
std::vector<Vec2> ramp_from(const PlaceGrid& grid, const PlaceSet& in, std::size_t start, double length);

/// Length of a path, mm.
double length_of(const std::vector<Vec2>& path);

}  // namespace riffler::plan
