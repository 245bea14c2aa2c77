// What a session left of its stock, from its journal.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/dexel/volume.hpp"
#include "riffler/session/journal.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::session {

/// The path that a stroke's poses mean to `carve`. A row that stands where the row before stood is no move: the tool
/// has cut there before. Only a stroke that never moves, of two rows or more, is one move: the tool cuts where it
/// stands. One row cuts nothing, as one pose does in `carve`.
std::vector<Pose> moves_of(const JournalStroke& stroke);

/// What the strokes have left.
struct Replayed {
  Volume volume;
  std::optional<Volume> mask;  ///< what is protected; nothing as long as no stroke has asked for it
};

/// The stock and its mask after the strokes that count, bit for bit as their moves left them one by one (MoveCarver,
/// carve of one stroke). The stock is a block, or its snapshot in `folder`, where the mask's is, too. Throws
/// std::invalid_argument naming the stroke: no stock, a tool that is not in `tools`, poses that make no move; a
/// snapshot that is no plain file name, or of another frame. FormatError as load(); Cancelled.
Replayed replay_all(const Journal& journal, const std::map<int, Tool>& tools, const std::filesystem::path& folder = {},
                    const Progress& progress = {});

/// The stock alone.
Volume replay(const Journal& journal, const std::map<int, Tool>& tools, const std::filesystem::path& folder = {},
              const Progress& progress = {});

}  // namespace riffler::session
