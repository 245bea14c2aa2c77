// How the cutter comes down into a layer that is open nowhere.
#pragma once

#include <vector>

#include "plan/place_grid.hpp"

namespace riffler::plan {

/// A helix around the only point of `path`, or a ramp to and fro along it if `radius` is 0.
struct Entry {
  std::vector<Vec2> path;
  double radius = 0;  ///< mm, of the helix
};

/// Tips from height `top` down to `z`, nowhere steeper than `slope` (rad). It ends at the helix's point in direction x,
/// or at the beginning of the ramp.
std::vector<Vec3> way_down(const Entry& entry, double top, double z, double slope);
/// What follows at height `z`, so that nothing slanted is left: once round and to the middle, or to the ramp's end.
std::vector<Vec3> level_way(const Entry& entry, double z);

/// A line of at most `length` (mm) within the places `in`, from `start` to a place that is as far as that allows.
std::vector<Vec2> ramp_from(const PlaceGrid& grid, const PlaceSet& in, std::size_t start, double length);

double length_of(const std::vector<Vec2>& path);

}  // namespace riffler::plan
