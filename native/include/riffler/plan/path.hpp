// Paths of a ball, or of any cutter, along a part.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "riffler/geom/vec.hpp"

namespace riffler::plan {

/// A curve of ball centres with the two contacts at each. Arrays have one entry per point.
struct PencilPath {
  double radius = 0;  ///< of the ball, mm
  bool closed = false;
  std::vector<Vec3> centres;
  std::vector<std::array<Vec3, 2>> contacts;  ///< mm; each side keeps its index along the path
  std::vector<std::array<Vec3, 2>> normals;   ///< unit normals of the part at the contacts, out of the material
  std::vector<Vec3> axes;                     ///< unit tool axes, tip to spindle; empty until oriented
  std::map<std::size_t, Vec3> keys;           ///< key axes by point index: input of the interpolation
  std::string interpolation;                  ///< name of the rule; see plan/orientation.hpp

  std::size_t size() const { return centres.size(); }
  /// Length of the curve in mm, including the closing edge.
  double length() const;
};

/// The path with added points, evenly spaced where two neighbours are more than `step` mm apart, so that keys can be
/// set there. Contacts and normals are interpolated; axes are dropped. Throws std::invalid_argument for a step that is
/// not positive and finite or that would create more than ten million points.
PencilPath divided(const PencilPath& path, double step);

}  // namespace riffler::plan
