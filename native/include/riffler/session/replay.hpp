// Rebuilds the stock of a session from its journal.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/dexel/volume.hpp"
#include "riffler/geom/rolled_pose.hpp"
#include "riffler/session/journal.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::session {

/// The poses to pass to `carve` for a stroke. A row with the same pose as the row before is not a move, since the tool
/// has already cut there. Exception: a stroke of two or more rows that never moves becomes one move, and the tool cuts
/// where it stands. A single row cuts nothing, as a single pose does in `carve`.
std::vector<Pose> moves_of(const JournalStroke& stroke);
/// Same for a stroke of a hand tool, which has a forward direction in each row.
std::vector<RolledPose> rolled_moves_of(const JournalStroke& stroke);

/// The result of all strokes.
struct Replayed {
  Volume volume;
  std::optional<Volume> mask;  ///< protected region; no value until a stroke protects something
};

/// Stock and protected region after the strokes that count, bit-identical to carving their moves one by one
/// (MoveCarver, or `carve` of one stroke). The stock is a block or its snapshot in `folder`, which also holds the
/// snapshot of the protected region. Throws std::invalid_argument naming the stroke: no stock, a tool missing in
/// `tools`, poses that make no move; a snapshot that is no plain file name or has another frame. FormatError as load();
/// Cancelled.
Replayed replay_all(const Journal& journal, const std::map<int, Tool>& tools, const std::filesystem::path& folder = {},
                    const Progress& progress = {});

/// The stock of replay_all.
Volume replay(const Journal& journal, const std::map<int, Tool>& tools, const std::filesystem::path& folder = {},
              const Progress& progress = {});

}  // namespace riffler::session
