// Converts a mesh to a volume by the winding number along each ray.
#pragma once

#include "riffler/base/progress.hpp"
#include "riffler/dexel/from_mesh/mesh_report.hpp"
#include "riffler/dexel/volume.hpp"
#include "riffler/mesh/mesh.hpp"

namespace riffler::dexel {

/// Returns a volume over frame.box that holds the points whose absolute generalized winding number |w| exceeds ½. Spans
/// end at crossings of the surface or, in an opening of a broken part, where |w| passes ½. A half-open rule on snapped
/// coordinates decides rays through vertices, edges and walls, so a closed part gives no odd number of crossings at any
/// alignment. Material outside the box is clipped. Throws std::invalid_argument for a mesh that is invalid or has no
/// volume.
///
/// Triangles are turned, and repeated ones removed, as mesh/orient.hpp describes; shells of a closed mesh are turned
/// only if the winding number is negative on some ray. Rays on the box's upper side, and a lone ray beyond it, count as
/// inside.
///
/// `report`, if given, receives the mesh's defects; its fractions refer to the part inside the box, over all
/// directions. `missed`, if given, receives whether all rays of the volume's reference direction miss a large part of a
/// mesh that lies within the box.
Volume from_mesh(const Mesh& mesh, const Frame& frame, const Progress& progress = {}, MeshReport* report = nullptr,
                 MissedMaterial* missed = nullptr);

}  // namespace riffler::dexel
