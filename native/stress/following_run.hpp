// The following stress run: a mesher follows random strokes; its mesh must have the bytes of a new one.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace riffler::stress {

/// Result of a series of strokes on one volume.
struct FollowedSeries {
  long strokes = 0;
  std::string problem;  ///< empty, or what failed and at which stroke
};

/// Runs series number `number`, which depends only on the seed and the number: up to `strokes` strokes on a random
/// volume. After each stroke compares the mesher's mesh with to_mesh's and, unless `tolerant` is false, the mesh and
/// the changed patches of a mesher with a tolerance with to_mesh(tolerance).
FollowedSeries follow_series(std::uint64_t seed, std::uint64_t number, long strokes, bool tolerant = true);

/// Runs series until `strokes` strokes are done. `progress` is called after each series and may stop the run by
/// returning false. Returns the first problem, or an empty text.
std::string follow_strokes(std::uint64_t seed, long strokes, const std::function<bool(long strokes)>& progress = {});

}  // namespace riffler::stress
