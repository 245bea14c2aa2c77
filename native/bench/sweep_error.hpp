// Distance of the ends of carved rays from the exact swept surface, by the independent reference.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "riffler/dexel/volume.hpp"
#include "riffler/geom/pose.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::bench {

/// One end of a span that a cut made.
struct EndError {
  double along = 0;  ///< mm along the ray to the exact end; 8 tolerances if there is none that near
  double space = 0;  ///< mm to the exact surface, perpendicular to it; measured if the ray grazes
  /// The ray grazes the surface: if it moves sideways by about the tolerance, its exact end moves by more than twice
  /// that or disappears. `space` counts for such an end, `along` for others.
  bool grazes = false;

  double error() const { return grazes ? space : along; }
};

struct SweepErrors {
  std::vector<EndError> ends;
  std::size_t points = 0;  ///< points on the rays that were compared
  std::size_t wrong = 0;   ///< points solid in one and further than the tolerance from solid in the other
};

/// Compares `rays` rays of every direction of `volume`, a block that the cutter of `tool` carved along `poses`. Three
/// quarters of the rays, chosen at random by `seed`, are cut; the others are next to cut ones, where lost slivers would
/// be. The result is the same for any number of threads.
SweepErrors sweep_errors(const Volume& volume, const Tool& tool, std::span<const Pose> poses, double tolerance,
                         int rays, std::uint64_t seed);

}  // namespace riffler::bench
