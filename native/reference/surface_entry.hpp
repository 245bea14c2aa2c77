// How deep a surface of triangles enters a tool that stands at one pose after another: what paths are judged by.
#pragma once

#include <span>
#include <vector>

#include "reference/assembly_distance.hpp"

namespace riffler::reference {

/// Where the surface stays out, `attained` is 0 and `bound` the gap.
struct Entry {
  double attained = 0;  ///< mm, at `point`
  double bound = 0;     ///< nothing is deeper, mm
  Vec3 point{0};
};

/// One for each pose, by branch and bound over every triangle until the two are at most `gap` apart, or `most`
/// parts of them have been looked at for it: then the bound is what is proven so far. Parallel over poses.
std::vector<Entry> entries(std::span<const Corners> triangles, const AssemblyDistance& tool,
                           std::span<const Pose> poses, double gap, std::size_t most = 1'000'000);

}  // namespace riffler::reference
