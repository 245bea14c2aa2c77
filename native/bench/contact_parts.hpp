// Parts of COL with triangles as CAD programs write them (long ones, needles, bores), and poses near these parts.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "riffler/geom/pose.hpp"
#include "riffler/mesh/mesh.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::bench {

/// A part and poses that touch it or nearly do.
struct ContactPart {
  Mesh mesh;
  std::vector<Pose> poses;
};

/// The parts that contact_part makes itself: "bore" (a cylinder R20 × 60 of 360 facets, 720 triangles as long as the
/// bore), "wall" (the same in 28 800 short ones), "box" (12 triangles), "prism" (32 sides), "needles" (a plate of
/// triangles 0.01 mm wide and 60 mm long).
const std::vector<std::string>& contact_part_names();

constexpr double kBoreRadius = 20;  ///< mm; the bore is about z, from z = 0 to 60
/// The part of that name, or one from an STL, OBJ or PLY file. Throws std::invalid_argument for a name that is neither.
Mesh contact_mesh(const std::string& name);

/// `name`: one of contact_part_names, or the path of an STL, OBJ or PLY file. `count` poses of `tool`: half of them, on
/// parts with valleys, on the pencil paths of a ball of the tool's diameter, up to 0.3 mm deep and tilted by up to 20°
/// from the valley's middle; the others at random places of the surface, from 2 mm above to 0.3 mm deep, tilted by up
/// to 45° from the normal. In bore and wall the axis is parallel to the bore's. Throws std::invalid_argument for a name
/// that is neither.
ContactPart contact_part(const std::string& name, const Tool& tool, int count, std::uint64_t seed);

}  // namespace riffler::bench
