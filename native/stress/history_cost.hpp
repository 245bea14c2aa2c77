// Cost of an edit of a history, compared with carving all strokes again.
#pragma once

#include <cstddef>
#include <string>

#include "riffler/sweep/history.hpp"

namespace riffler::stress {

struct HistoryCost {
  double replay = 0;                    ///< s of processor time to carve all strokes into the base
  double build = 0;                     ///< s to add them to a history, one by one
  double first = 0, any = 0, last = 0;  ///< s of an edit: of the first stroke; mean over the order; of the last one
  double strokes_run = 0, tiles_run = 0, tiles_restored = 0;  ///< means over edits of any stroke
  sweep::HistoryStats stats;                                  ///< after all edits
};

/// Edits one pose of a stroke and restores it, for strokes of 24 poses with a ball of Ø6 mm in a block of
/// 120 × 120 × 30 mm. Edits and replays alternate.
HistoryCost history_cost(std::size_t strokes, const std::string& directions, double pitch, std::size_t memory_limit);

}  // namespace riffler::stress
