// Key orientations on a path, and interpolation between them (4.3.3).
#pragma once

#include <map>
#include <optional>
#include <string_view>

#include "riffler/plan/path.hpp"

namespace riffler::plan {

/// How axes are interpolated between keys.
enum class Interpolation {
  Linear,  ///< (4.4)–(4.5): linear between the two axes by point index, then normalised
  Slerp,   ///< along the great circle, at a constant rate per arc length of the path
  Smooth,  ///< per arc length with a continuous first derivative: plan/smooth_axes.hpp
};

/// The rule named "linear", "slerp" or "smooth". Throws std::invalid_argument for other names.
Interpolation interpolation_named(std::string_view name);
/// The rule's name; inverse of interpolation_named.
const char* name_of(Interpolation rule);

/// The cone of all axes within `angle` (rad, below π) of the unit vector `about`: the range of a machine's rotary axes.
struct AxisLimit {
  Vec3 about{0, 0, 1};
  double angle = 0;
  bool project = false;  ///< true: move axes outside to the cone, along the great circle; false: error
};

/// `axis` if the limit allows it, otherwise the nearest axis that it allows.
Vec3 project(const AxisLimit& limit, const Vec3& axis);

/// Index of a path point (from 0) → unit axis, tip to spindle.
using OrientationKeys = std::map<std::size_t, Vec3>;

/// The path with an axis at every point. A key's axis is used unchanged at its point; before the first and after the
/// last key the nearest key's axis applies; a closed path also interpolates between last and first key. The keys are
/// stored with the path, so that single keys can be changed later. Throws std::invalid_argument naming the point: no
/// keys, a key outside the path, not finite or not a unit vector; neighbouring keys that are opposite within 1e-6 rad
/// (no unique great circle); an axis beyond `limit` unless the limit projects.
PencilPath oriented(const PencilPath& path, const OrientationKeys& keys, Interpolation rule,
                    const std::optional<AxisLimit>& limit = {});

/// The path with given axes at its points, for example from a file or a search. Keys and the name of the rule are
/// stored with it; nothing is interpolated. Throws std::invalid_argument as `oriented`.
PencilPath with_axes(const PencilPath& path, std::vector<Vec3> axes, const OrientationKeys& keys = {},
                     std::string interpolation = {});

}  // namespace riffler::plan
