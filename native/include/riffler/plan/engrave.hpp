// Engraving: curves laid on a part, cut to a depth with the axis following the surface.
#pragma once

#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/geom/pose.hpp"
#include "riffler/mesh/mesh.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::plan {

struct EngraveOptions {
  double depth = 0;         ///< below the surface, along its normal, mm; negative stays above it
  double inclination = 0;   ///< of the axis in the frame of feed and normal, rad (plan/cc_frame.hpp)
  double tilt = 0;          ///< likewise
  double tolerance = 0.01;  ///< of the cutter contact points' way, mm
  double turn = 0.0873;     ///< most that the axis may turn between two points, rad
  double crease = 0.5236;   ///< edges whose faces meet at less are facets of a round surface: normals vary over them
  double reach = 10;        ///< a curve may lie so far from the surface, mm
};

/// One curve on the part.
struct Engraved {
  std::vector<Vec3> contacts, normals;  ///< on the surface, before the depth
  std::vector<Pose> poses;              ///< of the tool, one for each
};

/// Every curve (points of a polyline, mm, near the part) is laid on the part by nearest points, divided until chords
/// stay within the tolerance of the surface and the axis turns little, and given the tool's location whose cutter
/// touches a plane at `depth` below the contact. Where it crosses an edge sharper than `crease` the axis turns there in
/// one point's step.
/// std::invalid_argument naming the curve and its point: fewer than two points, not finite, all at one place, further
/// than `reach` from the part; options that are not finite or out of range; an empty part.
std::vector<Engraved> engrave(const Mesh& part, const std::vector<std::vector<Vec3>>& curves, const Tool& tool,
                              const EngraveOptions& options = {}, const Progress& progress = {});

}  // namespace riffler::plan
