// A stroke of a history.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "riffler/dexel/volume.hpp"
#include "riffler/geom/pose.hpp"
#include "riffler/geom/rolled_pose.hpp"
#include "riffler/sweep/carve_options.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::sweep {

/// Names a stroke of one History. Positive; a removed stroke's id is never given again.
using StrokeId = std::uint64_t;

/// One call of `carve`, as its arguments.
struct HistoryStroke {
  Tool tool;
  std::vector<Pose> poses;  ///< of a tool of revolution; empty for a hand tool
  CarveMode mode = CarveMode::Remove;
  double tolerance = 0.01;           ///< mm
  std::optional<Volume> protect{};   ///< region that must not change
  std::vector<RolledPose> rolled{};  ///< poses of a hand tool; empty for others
};

}  // namespace riffler::sweep
