// The following stress run: a mesher with a tolerance follows random strokes, and has to have the bytes of a new mesh.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace riffler::stress {

/// What a series of strokes on one volume came to.
struct FollowedSeries {
  long strokes = 0;
  std::string problem;  ///< empty, or what failed and at which stroke
};

/// Series number `number`, which depends on nothing but the seed and the number: up to `strokes` strokes on a volume
/// drawn at random. After each the mesher's mesh is compared with to_mesh's; and, unless `tolerant` is false, that of a
/// mesher with a tolerance, and the patches that it names, with to_mesh(tolerance).
FollowedSeries follow_series(std::uint64_t seed, std::uint64_t number, long strokes, bool tolerant = true);

/// Series until `strokes` strokes were made. `progress`, called after each series, may stop the run by returning false.
/// Returns the first problem, or nothing.
std::string follow_strokes(std::uint64_t seed, long strokes, const std::function<bool(long strokes)>& progress = {});

}  // namespace riffler::stress
