// The mesh of a volume that goes on changing.
#pragma once

#include <memory>
#include <vector>

#include "dexel/volume.hpp"
#include "geom/progress.hpp"
#include "mesh/mesh.hpp"

namespace riffler {

namespace marching {
struct MeshState;
}

/// The part of a mesh in one brick of 32 × 32 × 32 cells: its own vertices, then those of its neighbours that its
/// triangles touch. World frame. What two patches share has the same coordinates in both, bit for bit, and no other
/// vertices of a mesh have.
struct MeshPatch {
  BulkVector<Vec3f> vertices;
  Triangles triangles;
  std::size_t own = 0;  ///< vertices that are the brick's own
};

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
  /// Empty for a brick without triangles. Throws std::out_of_range for a number that no brick has.
  MeshPatch patch(std::size_t brick) const;
  /// The whole mesh: the same as to_mesh of the volume.
  Mesh mesh() const;
  std::size_t triangles() const;

 private:
  std::unique_ptr<marching::MeshState> state_;
};

}  // namespace riffler
