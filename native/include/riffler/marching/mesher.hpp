// The mesh of a volume that goes on changing.
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

/// Holds a volume's mesh in bricks, and meshes those again that a change of the volume reached. What it has then is,
/// bit for bit, what meshing the whole volume would have given.
class Mesher {
 public:
  /// Meshes the whole volume; throws as to_mesh does.
  explicit Mesher(const Volume& volume, const Progress& progress = {});
  ~Mesher();
  Mesher(Mesher&&) noexcept;
  Mesher& operator=(Mesher&&) noexcept;

  /// Meshes what is not as it was, and returns the numbers of the bricks whose patches are others now, ascending. What
  /// it costs depends on what changed and on the number of tiles, not on the size of the mesh. Throws
  /// std::invalid_argument for a volume of another frame. If it fails for another reason (memory, more than 2³¹
  /// triangles) there is no mesh, and asking for it throws std::runtime_error, until an update succeeds.
  std::vector<std::size_t> update(const Volume& volume);

  /// Numbers of the bricks that have triangles, ascending.
  std::vector<std::size_t> patches() const;
  /// Bricks along each axis of the lattice, with triangles or without: brick n stands at (n / cz / cy, n / cz % cy,
  /// n % cz).
  Vec3i shape() const;
  /// One patch of all these bricks, in their order, without seams between them; empty where none has triangles. Throws
  /// std::out_of_range for a number that no brick has, std::invalid_argument for one that is there twice.
  MeshPatch patch(std::span<const std::size_t> bricks) const;
  MeshPatch patch(std::size_t brick) const { return patch(std::span(&brick, 1)); }
  /// Of each corner of a patch's triangles the normal on the whole mesh: the mean of the triangles around its vertex,
  /// in whatever brick, that are within `sharp` (rad) of its own. (3 triangles), unit.
  base::BulkVector<Vec3f> corner_normals(const MeshPatch& patch, double sharp) const;
  /// The whole mesh: the same as to_mesh of the volume.
  Mesh mesh() const;
  std::size_t triangles() const;

  /// The first point of the surface along a ray from `origin` in `direction` (of any length but 0), seen from outside
  /// or inside the material; nothing where there is none. No ray falls through between triangles, and a point that lies
  /// on the surface is at distance 0. Bricks that changed are made ready for it as rays come to them. Throws
  /// std::invalid_argument where one is not finite, or the direction is zero.
  std::optional<SurfaceHit> pick(const Vec3& origin, const Vec3& direction, PickStats& stats);
  /// The surface as it is now, to be picked while this goes on: a stroke that follows what was there when it began does
  /// not climb into its own groove. Costs what changed since the last time, at first all; from then on 25 bytes a
  /// triangle are kept here and shared.
  FrozenSurface freeze(PickStats& stats);

 private:
  std::unique_ptr<MeshState> state_;
};

}  // namespace riffler::marching
