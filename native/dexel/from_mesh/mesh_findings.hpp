// What filling a volume finds out about its mesh.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "riffler/mesh/mesh.hpp"

namespace riffler::dexel {

/// What the winding numbers of columns tell about a mesh.
struct ColumnTally {
  double inside = 0, overlap = 0, inside_out = 0;  // mm of rays
  double enclosed = 0;                             // mm³: winding numbers × lengths × areas
  std::size_t rays = 0, doubtful = 0;

  void operator+=(const ColumnTally& o) {
    inside += o.inside, overlap += o.overlap, inside_out += o.inside_out, enclosed += o.enclosed;
    rays += o.rays, doubtful += o.doubtful;
  }
};

/// The tally of all grids, and the triangles at which negative winding numbers begin or end.
struct MeshFindings {
  explicit MeshFindings(const Mesh& mesh) : flipped(mesh.triangles.size()) {}

  ColumnTally tally;
  std::vector<std::uint8_t> flipped;

  /// Of the rays' lengths within the material, 1 at most.
  double share(double length) const { return tally.inside > 0 ? std::min(1.0, length / tally.inside) : 0; }
};

}  // namespace riffler::dexel
