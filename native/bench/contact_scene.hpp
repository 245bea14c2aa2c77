// The scene of COL: a part with sharp valleys, and a tool near it at many poses.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "riffler/geom/pose.hpp"
#include "riffler/mesh/mesh.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::bench {

constexpr double kValleySide = 100;  ///< mm

/// A sheet over 0 … 100 mm in x and y of `squares`² squares of two triangles. Its height is a sum of |sin|, so valleys
/// are sharp and ridges round; it varies by about 7.5 mm.
Mesh valleys(int squares);
/// Height of that sheet's triangles at a place, mm.
double valley_height(const Mesh& sheet, int squares, double x, double y);

struct ContactTool {
  std::string name;
  Tool tool;
};
/// "long" and "short": ball R3 with shank, taper and holder R20, which is too high to touch the part in "long" and hits
/// it in "short". "plain": a ball R3 × 30 alone.
std::vector<ContactTool> contact_tools();

/// `count` poses: the tip 0.3 mm below to 2 mm above the sheet, the axis tilted from z by up to 30°, in any direction.
std::vector<Pose> contact_poses(const Mesh& sheet, int squares, int count, std::uint64_t seed);

/// The tool as a mesh for other libraries: its outline turned about its axis in `segments` steps, arcs divided into
/// steps of the same length.
Mesh turned(const Tool& tool, int segments);

}  // namespace riffler::bench
