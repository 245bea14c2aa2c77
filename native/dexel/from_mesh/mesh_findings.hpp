// What filling a volume reveals about its mesh.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "riffler/mesh/mesh.hpp"

namespace riffler::dexel {

/// Sums over the columns, by winding number.
struct ColumnTally {
  double inside = 0, overlap = 0, inside_out = 0;  // mm of ray length
  double enclosed = 0;                             // mm³: winding number × length × cell area
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

  /// `length` as a fraction of the ray length inside the material, at most 1.
  double share(double length) const { return tally.inside > 0 ? std::min(1.0, length / tally.inside) : 0; }
};

}  // namespace riffler::dexel
