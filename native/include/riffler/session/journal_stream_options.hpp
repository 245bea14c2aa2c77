// Options of the stream of strokes from the haptic loop to a journal on disk.
#pragma once

#include <cstddef>

#include "riffler/session/journal_rules.hpp"

namespace riffler::session {

/// Ring size and timing of the stream.
struct JournalStreamOptions {
  std::size_t rows = 1 << 16;            ///< capacity of the ring, 128 bytes per row: 65 s at 1000 Hz
  double drain = 0.05;                   ///< s between two reads of the ring
  double sync = 1;                       ///< s between two syncs while rows arrive; every end of a stroke also syncs
  double retry = 1;                      ///< s between a failed write and the next attempt
  StrokeMode mode = StrokeMode::Remove;  ///< mode of all strokes
};

}  // namespace riffler::session
