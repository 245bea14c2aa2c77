// Key orientations on a path and what is interpolated between them (4.3.3).
#pragma once

#include <map>
#include <optional>
#include <string_view>

#include "riffler/plan/path.hpp"

namespace riffler::plan {

enum class Interpolation {
  Linear,  ///< (4.4)–(4.5): straight between the two axes by number of points, made unit
  Slerp,   ///< the great circle between them, at constant rate by arc length of the path
  Smooth,  ///< by arc length, with a continuous first derivative: plan/smooth_axes.hpp
};

/// "linear", "slerp", "smooth"; std::invalid_argument naming others.
Interpolation interpolation_named(std::string_view name);
const char* name_of(Interpolation rule);

/// All axes within `angle` (rad, below π) of the unit vector `about`: how far a machine's rotary axes reach.
struct AxisLimit {
  Vec3 about{0, 0, 1};
  double angle = 0;
  bool project = false;  ///< move axes beyond it onto the cone, along the great circle; otherwise they are an error
};

/// `axis`, or the nearest one that the limit allows.
Vec3 project(const AxisLimit& limit, const Vec3& axis);

/// Numbers of points, from 0, and unit axes, tip to spindle.
using OrientationKeys = std::map<std::size_t, Vec3>;

/// The path with axes at all its points: a key's at its point, to the bit; before the first key and after the last that
/// key's; on a loop also between the last and the first. The keys stay with the path, so that some can be set again,
/// and any interpolated axis is adjusted by making it one.
/// std::invalid_argument naming the point: no key at all, a key outside the path, not finite, not a unit vector;
/// neighbouring keys that are opposite (within 1e-6 rad: no great circle), an axis beyond `limit` unless it projects.
PencilPath oriented(const PencilPath& path, const OrientationKeys& keys, Interpolation rule,
                    const std::optional<AxisLimit>& limit = {});

/// The path with these axes at its points, which came about elsewhere: from a file, from a search. The keys and the
/// name of the rule are kept with it, nothing is interpolated. std::invalid_argument as for `oriented`.
PencilPath with_axes(const PencilPath& path, std::vector<Vec3> axes, const OrientationKeys& keys = {},
                     std::string interpolation = {});

}  // namespace riffler::plan
