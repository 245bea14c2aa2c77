// Defects of a mesh that was converted to a volume.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "riffler/mesh/mesh.hpp"

namespace riffler::dexel {

/// Defects of a mesh and their effect on the volume made from it. All zero (but `triangles`): a closed, consistently
/// oriented surface that does not intersect itself. Vertices with equal coordinates count as one.
struct MeshReport {
  std::size_t triangles = 0;           ///< triangles of the mesh
  std::size_t degenerate = 0;          ///< triangles that name a vertex twice or have an area of exactly 0 in double
  std::size_t duplicates = 0;          ///< triangles with the same three vertices as an earlier one, in any order
  std::size_t open_edges = 0;          ///< edges used by one triangle
  std::size_t nonmanifold_edges = 0;   ///< edges used by three or more triangles
  std::size_t inconsistent_edges = 0;  ///< edges used by two triangles in the same direction
  std::size_t openings = 0;            ///< closed loops along which the surface ends
  std::size_t turned = 0;              ///< triangles turned to agree with their neighbours
  std::size_t left_out = 0;            ///< repeated triangles removed because together they tear the surface open
  std::size_t one_sided = 0;           ///< pieces (connected across edges) with one side only; unchanged
  std::size_t flipped_shells = 0;      ///< pieces (connected across edges) that face into the material
  double inside_out = 0;               ///< fraction of the volume where the winding number is negative
  double overlap = 0;                  ///< fraction of the volume where the winding number is ≥ 2 or ≤ −2
  double doubtful_rays = 0;            ///< fraction of the rays with material that end in an opening, where |w| = ½

  /// Whether there is nothing to report.
  bool clean() const {
    return degenerate + duplicates + open_edges + nonmanifold_edges + inconsistent_edges + openings + turned +
                   left_out + one_sided + flipped_shells ==
               0 &&
           inside_out == 0 && overlap == 0 && doubtful_rays == 0;
  }
};

/// Material of a mesh that is thinner than the pitch, so that no ray met it.
struct MissedMaterial {
  double volume = 0;  ///< mm³; 0 if less than a tenth of the mesh's volume or unknown
  double pitch = 0;   ///< mm, a pitch that would keep the material, estimated from volume and area
  Box3 box;           ///< of the mesh
};

/// Counts the mesh's triangles and the defects of triangles and edges.
void count_defects(const Mesh& mesh, MeshReport& report);

/// Number of pieces (connected across edges) that contain a triangle with a non-zero mark.
std::size_t count_shells(const Mesh& mesh, const std::vector<std::uint8_t>& marks);

}  // namespace riffler::dexel
