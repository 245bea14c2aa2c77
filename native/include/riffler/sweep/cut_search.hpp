// Which move made a surface. Nothing is stored while cutting: the moves are searched when a caller asks.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/geom/pose.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::sweep {

/// One move of a tool of a list. `id` is what `find` returns: a row, a stroke.
struct SearchedMove {
  Pose from, to;
  std::uint32_t tool;
  std::int32_t id;
};

/// Finds the moves whose cutters swept along given points.
class CutSearch {
 public:
  /// `moves` in the order in which they were made. `tolerance` (mm): points farther from every swept body than this
  /// were made by no move. Throws std::invalid_argument for a tolerance that is not positive, a tool that is not in the
  /// list, and poses that `carve` refuses.
  CutSearch(std::vector<Tool> tools, std::vector<SearchedMove> moves, double tolerance);
  ~CutSearch();
  CutSearch(CutSearch&&) noexcept;
  CutSearch& operator=(CutSearch&&) noexcept;

  /// For each point (mm) the id of the move whose swept surface is nearest; among those that are as near within a
  /// twentieth of the tolerance, the first: it made the surface, and the others only moved along it. −1 without one.
  std::vector<std::int32_t> find(std::span<const Vec3> points, const Progress& progress = {}) const;

 private:
  struct Core;
  std::unique_ptr<const Core> core_;
};

}  // namespace riffler::sweep
