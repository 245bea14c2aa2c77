// How far the ends of carved rays are from the exact swept surface, by the independent reference.
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
  double along = 0;  ///< mm along the ray to the exact end; 8 tolerances where there is none as near
  double space = 0;  ///< mm to the exact surface, square to it; measured where the ray grazes
  /// The ray grazes the surface: moved sideways by about the tolerance, its exact end moves by more than twice that, or
  /// is gone. Such an end is held to `space`, others to `along`.
  bool grazes = false;

  double error() const { return grazes ? space : along; }
};

struct SweepErrors {
  std::vector<EndError> ends;
  std::size_t points = 0;  ///< points on the rays that were compared
  std::size_t wrong = 0;   ///< of them, solid here and further than the tolerance from solid there, or the reverse
};

/// Compares `rays` rays of every direction of `volume`, a block that the cutter of `tool` carved along `poses`. Three
/// quarters of the rays, chosen at random by `seed`, are cut, the others lie next to cut ones: lost slivers would be
/// there. The same for any number of threads.
SweepErrors sweep_errors(const Volume& volume, const Tool& tool, std::span<const Pose> poses, double tolerance,
                         int rays, std::uint64_t seed);

}  // namespace riffler::bench
