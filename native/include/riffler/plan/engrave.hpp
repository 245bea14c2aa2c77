// Engraving: curves projected onto a part and cut to a depth, with the axis following the surface.
#pragma once

#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/geom/pose.hpp"
#include "riffler/mesh/mesh.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::plan {

/// Options of engrave.
struct EngraveOptions {
  double depth = 0;         ///< mm below the surface along its normal; negative: above
  double inclination = 0;   ///< rad, of the axis in the frame of feed and normal (plan/cc_frame.hpp)
  double tilt = 0;          ///< rad, in the same frame
  double tolerance = 0.01;  ///< mm between the surface and the polyline of cutter contact points
  double turn = 0.0873;     ///< largest rotation of the axis between two points, rad
  double crease = 0.5236;   ///< rad; smaller edge angles count as a curved surface, with interpolated normals
  double reach = 10;        ///< largest distance of a curve from the surface, mm
};

/// One curve on the part.
struct Engraved {
  std::vector<Vec3> contacts, normals;  ///< on the surface, before the depth is applied
  std::vector<Pose> poses;              ///< tool pose per contact
};

/// Projects every curve (a polyline of points near the part, mm) to the nearest points of the part, subdivides it until
/// chords stay within `tolerance` of the surface and the axis turns by at most `turn`, and computes the tool pose whose
/// cutter touches a plane at `depth` below the contact. At an edge sharper than `crease` the axis turns within one
/// step. Throws std::invalid_argument naming the curve and its point: fewer than two points, a point that is not
/// finite, all points in one place, a point further than `reach` from the part. Also for options that are not finite or
/// out of range, and for an empty part.
std::vector<Engraved> engrave(const Mesh& part, const std::vector<std::vector<Vec3>>& curves, const Tool& tool,
                              const EngraveOptions& options = {}, const Progress& progress = {});

}  // namespace riffler::plan
