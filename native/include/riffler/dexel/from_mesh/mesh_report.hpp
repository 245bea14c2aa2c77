// What was wrong with a part that became a volume.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "riffler/mesh/mesh.hpp"

namespace riffler::dexel {

/// Defects of a mesh and what they mean for the volume made of it. All zero: a closed, consistently oriented surface
/// that nowhere lies within itself. Vertices with equal coordinates count as one.
struct MeshReport {
  std::size_t triangles = 0;           ///< of the mesh
  std::size_t degenerate = 0;          ///< triangles that name a vertex twice or whose area is exactly 0 in double
  std::size_t duplicates = 0;          ///< triangles whose three vertices an earlier one has, in whatever order
  std::size_t open_edges = 0;          ///< used by one triangle
  std::size_t nonmanifold_edges = 0;   ///< used by three or more
  std::size_t inconsistent_edges = 0;  ///< used by two that run it in the same direction
  std::size_t openings = 0;            ///< closed walks along which the surface ends
  std::size_t turned = 0;              ///< triangles turned to agree with their neighbours
  std::size_t left_out = 0;            ///< repeated triangles left out, as together they tear the surface open
  std::size_t one_sided = 0;           ///< pieces connected across edges that have no two sides, left as they are
  std::size_t flipped_shells = 0;      ///< pieces connected across edges that face into the material
  double inside_out = 0;               ///< share of the volume where the winding number is negative
  double overlap = 0;                  ///< share of the volume where it is 2 or more, or −2 or less
  double doubtful_rays = 0;  ///< share of the rays with material that end in an opening, on |w| = ½, not on the surface

  /// Nothing to tell.
  bool clean() const {
    return degenerate + duplicates + open_edges + nonmanifold_edges + inconsistent_edges + openings + turned +
                   left_out + one_sided + flipped_shells ==
               0 &&
           inside_out == 0 && overlap == 0 && doubtful_rays == 0;
  }
};

/// Material of a mesh that no ray met, since it is thinner than the pitch.
struct MissedMaterial {
  double volume = 0;  ///< mm³; 0 where it is less than a tenth of the mesh's volume, or where that is not known
  double pitch = 0;   ///< mm: what keeps it, guessed from volume and area
  Box3 box;           ///< of the mesh
};

/// Counts triangles and edges.
void count_defects(const Mesh& mesh, MeshReport& report);

/// Pieces connected across edges that have a triangle with `marks` in them.
std::size_t count_shells(const Mesh& mesh, const std::vector<std::uint8_t>& marks);

}  // namespace riffler::dexel
