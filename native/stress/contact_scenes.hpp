// Random parts, tools and poses from the degenerate limits, for the stress run of contact.
#pragma once

#include <vector>

#include "riffler/geom/pose.hpp"
#include "riffler/mesh/mesh.hpp"
#include "riffler/tool/tool.hpp"
#include "stress/random.hpp"

namespace riffler::stress {

enum class ContactScene {
  Sheet,    ///< random heights over squares, open at its border
  Soup,     ///< random triangles: needles, without area, duplicates, coinciding walls
  Blocks,   ///< boxes face to face, with shared walls
  Spikes,   ///< a fan of needles that meet in one vertex
  FarAway,  ///< a sheet at coordinates of 1e5 mm
  Flat,     ///< one plane in large triangles, so that tools touch it exactly
  Bore,     ///< a cylindrical hole whose triangles are as long as the hole
  Prism,    ///< a block with few sides, or a box of 12 triangles
  Needles,  ///< a wavy sheet of narrow strips
  kCount
};
const char* name(ContactScene scene);

Mesh draw_part(Random& random, ContactScene scene);
/// A random cutter of any kind, usually with shank and holder.
Tool draw_tool(Random& random);
/// A random pose near the surface, tangent to it, deep in it, or far away.
Pose draw_pose(Random& random, const Mesh& part, const Tool& tool);

}  // namespace riffler::stress
