// The scene of COL: a part with sharp valleys, a tool held near it at many poses.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "riffler/geom/pose.hpp"
#include "riffler/mesh/mesh.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::bench {

constexpr double kValleySide = 100;  ///< mm

/// A sheet over 0 … 100 mm in x and y of `squares`² squares of two triangles: a sum of |sin|, so valleys are sharp and
/// ridges round, about 7.5 mm from the lowest to the highest place.
Mesh valleys(int squares);
/// Height of that sheet's triangles at a place, mm.
double valley_height(const Mesh& sheet, int squares, double x, double y);

struct ContactTool {
  std::string name;
  Tool tool;
};
/// Ball R3, shank, taper and holder R20: one whose holder stands too high to touch the part, and one whose holder hits;
/// and "plain", a ball R3 × 30 alone.
std::vector<ContactTool> contact_tools();

/// `count` poses: the tip 0.3 mm below to 2 mm above the sheet, the axis tilted from z by up to 30°, in any direction.
std::vector<Pose> contact_poses(const Mesh& sheet, int squares, int count, std::uint64_t seed);

/// The tool's outline turned about its axis in `segments` steps, its arcs in steps as long: what others take for it.
Mesh turned(const Tool& tool, int segments);

}  // namespace riffler::bench
