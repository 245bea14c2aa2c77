// Keeps the mesh of a changing volume up to date.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/dexel/volume.hpp"
#include "riffler/marching/patch.hpp"
#include "riffler/marching/pick.hpp"
#include "riffler/mesh/mesh.hpp"

namespace riffler::marching {

struct MeshState;

/// Keeps a volume's mesh in bricks and re-meshes only the bricks that a change of the volume affects. The result is
/// bit-identical to meshing the whole volume.
class Mesher {
 public:
  /// Meshes the whole volume. Throws as to_mesh does.
  explicit Mesher(const Volume& volume, const Progress& progress = {});
  /// Leaves out the triangles that are not needed for `tolerance` (mm), as to_mesh(volume, tolerance) does, whose mesh
  /// it keeps bit for bit. The full mesh stays in memory, for the next update and for picking; it all takes about
  /// 10 bytes for each triangle of the full mesh more than without a tolerance.
  Mesher(const Volume& volume, double tolerance, const Progress& progress = {});
  ~Mesher();
  Mesher(Mesher&&) noexcept;
  Mesher& operator=(Mesher&&) noexcept;

  /// Re-meshes the bricks that have changed and returns the numbers of those whose patch differs now, ascending. The
  /// cost depends on the size of the change and the number of tiles, not on the size of the mesh. Throws
  /// std::invalid_argument for a volume with another frame. If it fails for another reason (memory, more than 2³¹
  /// triangles), the mesher has no mesh, and reading it throws std::runtime_error until an update succeeds. `normals`:
  /// also returns the bricks whose triangles are the same, but whose corner_normals may differ, next to changed ones.
  std::vector<std::size_t> update(const Volume& volume, bool normals = false);

  /// Numbers of the bricks that have triangles, ascending.
  std::vector<std::size_t> patches() const;
  /// Number of bricks (cx, cy, cz) along each axis of the lattice, with or without triangles. Brick n is at (n / cz /
  /// cy, n / cz % cy, n % cz).
  Vec3i shape() const;
  /// One patch of these bricks, in the given order, without seams between them; empty if none has triangles. Throws
  /// std::out_of_range for a number that is no brick's, std::invalid_argument for a repeated number.
  MeshPatch patch(std::span<const std::size_t> bricks) const;
  MeshPatch patch(std::size_t brick) const { return patch(std::span(&brick, 1)); }
  /// Unit normals at the corners of a patch's triangles, 3 per triangle. Each is the mean over the triangles of the
  /// whole mesh that share the corner's vertex and whose normal is within `sharp` (rad) of the triangle's own; with a
  /// tolerance, over those of the full mesh that bend no more than the surface under the triangle does, so that long
  /// triangles are shaded like the small ones that they replace, and not by the wall of a groove next to them.
  base::BulkVector<Vec3f> corner_normals(const MeshPatch& patch, double sharp) const;
  /// The whole mesh: the same as to_mesh of the volume, with the mesher's tolerance.
  Mesh mesh() const;
  /// Number of triangles of the whole mesh.
  std::size_t triangles() const;
  /// Number of triangles of the full mesh: the same without a tolerance.
  std::size_t all_triangles() const;

  /// The first point of the full surface along the ray from `origin` (mm) in `direction` (any length but 0), from
  /// outside or inside the material; nothing if there is none. No ray passes between adjacent triangles; a point on the
  /// surface has distance 0. Changed bricks are prepared when a ray first reaches them. Throws std::invalid_argument if
  /// an argument is not finite or the direction is zero.
  std::optional<SurfaceHit> pick(const Vec3& origin, const Vec3& direction, PickStats& stats);
  /// A frozen copy of the current surface, for picking while the mesher continues to change: a stroke that follows the
  /// surface as it was at its start does not climb into its own groove. Costs time in proportion to the changes since
  /// the last call (the first call: all bricks) and from then on 25 bytes per triangle, shared with the mesher.
  FrozenSurface freeze(PickStats& stats);

 private:
  std::unique_ptr<MeshState> state_;
};

}  // namespace riffler::marching
