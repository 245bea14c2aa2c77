// Mesh → volume by winding number along each column.
#pragma once

#include "riffler/base/progress.hpp"
#include "riffler/dexel/from_mesh/mesh_report.hpp"
#include "riffler/dexel/volume.hpp"
#include "riffler/mesh/mesh.hpp"

namespace riffler::dexel {

/// A volume over frame.box filled with the points whose absolute generalized winding number exceeds ½: spans end at
/// crossings of the surface, or, in an opening of a broken part, where |w| passes ½. Rays on vertices, edges and walls
/// are decided by a half-open rule on snapped coordinates, so a closed part has no odd ray at any alignment. What lies
/// outside the box is clipped. Throws std::invalid_argument for a mesh that is invalid or has no volume. `report`,
/// where it is given, is filled with what was wrong with the mesh; shares are of what lies within the box, all
/// directions.
/// Triangles are turned, and repeated ones left out, as mesh/orient.hpp says; shells of a closed mesh only where
/// winding numbers are negative on some column. Rays on the box's upper side, and a lone ray beyond it, are taken for
/// what is within. `missed`, where it is given, says whether all rays of the volume's reference direction miss much of
/// a mesh that lies within the box.
Volume from_mesh(const Mesh& mesh, const Frame& frame, const Progress& progress = {}, MeshReport* report = nullptr,
                 MissedMaterial* missed = nullptr);

}  // namespace riffler::dexel
