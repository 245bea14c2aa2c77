// Depth to which a triangle surface enters a tool at each of several poses: the reference for paths.
#pragma once

#include <span>
#include <vector>

#include "reference/assembly_distance.hpp"

namespace riffler::reference {

/// Depth at one pose. If the surface stays outside the tool, `attained` is 0 and `bound` is the gap.
struct Entry {
  double attained = 0;  ///< mm, at `point`
  double bound = 0;     ///< upper bound on the depth, mm
  Vec3 point{0};
};

/// Computes one entry for each pose by branch and bound over every triangle, until `attained` and `bound` are at most
/// `gap` apart. After `most` parts of triangles, returns the bound proven so far. Parallel over poses.
std::vector<Entry> entries(std::span<const Corners> triangles, const AssemblyDistance& tool,
                           std::span<const Pose> poses, double gap, std::size_t most = 1'000'000);

}  // namespace riffler::reference
