// Removes the triangles that a mesh's shape does not need.
#pragma once

#include <vector>

#include "marching/star_collapse.hpp"
#include "marching/surface.hpp"
#include "marching/vertex_groups.hpp"

namespace riffler::marching {

/// Simplifies the whole mesh of a surface whose bricks are `all`. Removed triangles get −1 for all their vertices. No
/// point of the new surface is farther than `tolerance` (mm) from the old one, and the reverse. The vertices marked in
/// `fixed` stay, and no other is merged into them.
void simplify(Surface& surface, const std::vector<std::size_t>& all, double tolerance,
              const base::BulkVector<std::uint8_t>& fixed, const Progress& progress);

/// Whether two triangles with a common side lie on each other.
bool lie_on(const mesh::Vertices& vertices, const Vec3i& one, const Vec3i& other);

/// Marks in `fixed` the vertices of triangles that lie on each other. Returns whether it marked any that was not.
///
/// A merge sees only the triangles around its group, so across the border of a group two triangles may fold. That is
/// rare; the mesh is then simplified again from the start, with those vertices fixed. In the end no triangle folds that
/// did not in the full mesh: one whose vertices are all fixed has never changed.
bool fix_folds(const Surface& surface, const std::vector<std::size_t>& all, base::BulkVector<std::uint8_t>& fixed);

}  // namespace riffler::marching
