// Removes the triangles that a mesh's shape does not need.
#pragma once

#include <vector>

#include "marching/star_collapse.hpp"
#include "marching/surface.hpp"

namespace riffler::marching {

/// The vertices of a brick in 8 groups. Bit a of a vertex's group says that its cell is the brick's last along axis a,
/// so that the triangles around it belong to this brick and the next one along that axis. Group 0 lies inside the
/// brick, 1, 2 and 4 on its upper faces, 3, 5 and 6 on its upper edges; group 7, at its corner, never changes.
///
/// The groups take turns, edges first, then faces, then the inside. The vertices of two groups that take the same turn
/// are two cells or more apart along some axis, so they never share a triangle: neither in the full mesh nor later,
/// because a merge gives a triangle another vertex of the same group only. So they can be processed in parallel, and
/// what bricks share is simplified once, from triangles on both sides.
inline constexpr std::array<std::uint8_t, 7> kTurns{3, 6, 5, 1, 2, 4, 0};

/// Simplifies the whole mesh of a surface whose bricks are `all`. Removed triangles get −1 for all their vertices. No
/// point of the new surface is farther than `tolerance` (mm) from the old one, and the reverse. The vertices marked in
/// `fixed` stay, and no other is merged into them.
void simplify(Surface& surface, const std::vector<std::size_t>& all, double tolerance,
              const base::BulkVector<std::uint8_t>& fixed, const Progress& progress);

/// Marks in `fixed` the vertices of triangles that lie on each other. Returns whether it marked any that was not.
///
/// A merge sees only the triangles around its group, so across the border of a group two triangles may fold. That is
/// rare; the mesh is then simplified again from the start, with those vertices fixed. In the end no triangle folds that
/// did not in the full mesh: one whose vertices are all fixed has never changed.
bool fix_folds(const Surface& surface, const std::vector<std::size_t>& all, base::BulkVector<std::uint8_t>& fixed);

}  // namespace riffler::marching
