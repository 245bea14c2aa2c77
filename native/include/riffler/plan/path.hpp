// Paths of a ball, or of any cutter, along a part.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "riffler/geom/vec.hpp"

namespace riffler::plan {

/// A curve of ball centres, with what the ball touches at each. All arrays have one entry per point.
struct PencilPath {
  double radius = 0;  ///< of the ball, mm
  bool closed = false;
  std::vector<Vec3> centres;
  std::vector<std::array<Vec3, 2>> contacts;  ///< each side keeps its place along the path
  std::vector<std::array<Vec3, 2>> normals;   ///< of the part at the contacts, out of the material
  std::vector<Vec3> axes;                     ///< tool axes, tip to spindle; empty until it is oriented
  std::map<std::size_t, Vec3> keys;           ///< what the axes were interpolated from, by number of the point
  std::string interpolation;                  ///< by which rule; see plan/orientation.hpp

  std::size_t size() const { return centres.size(); }
  /// mm, of the closing edge too.
  double length() const;
};

/// The path with further points, evenly between two that are more than `step` mm apart, so that keys can be set there;
/// their contacts and normals lie between those of the two. Without axes. std::invalid_argument for a step that is not
/// positive and finite or would make more than ten million points.
PencilPath divided(const PencilPath& path, double step);

}  // namespace riffler::plan
