// The scenes that every benchmark shares: B200's path, B5X's, and the named cutters.
#pragma once

#include <string>
#include <vector>

#include "riffler/geom/pose.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::bench {

/// Moves of B200 and B5X.
constexpr int kMoves = 200;
/// Block of B200 and B5X: from 0 to this.
inline const Vec3 kBlock{100, 60, 30};

/// B200's ball centre after `k` moves.
Vec3 centre(int k);

/// Tool poses along the centres: the tool's point `centre_height` above its tip is at the centre. The axis is upright
/// (B200) or, if `turning`, swings by 30° about x and by 20° about y, two periods of each (B5X).
std::vector<Pose> path(double centre_height, bool turning);

/// A cutter and the height of the point that follows the path: the centre of the rounding at its end; 0 for a flat end,
/// the end of the first cone for a sharp one.
struct NamedCutter {
  std::string name;
  Tool tool;
  double centre_height;
};

/// One of each kind.
std::vector<NamedCutter> named_cutters();

}  // namespace riffler::bench
