// How strokes go from the haptic loop to a journal on disk.
#pragma once

#include <cstddef>

#include "riffler/session/journal_rules.hpp"

namespace riffler::session {

struct JournalStreamOptions {
  std::size_t rows = 1 << 16;  ///< that may wait, 128 bytes each: 65 s at 1000 Hz
  double drain = 0.05;         ///< s from one look at the ring to the next
  double sync = 1;             ///< s from one sync to the next while rows come; and one for each end of a stroke
  double retry = 1;            ///< s from one refusal of the disk to the next attempt
  StrokeMode mode = StrokeMode::Remove;  ///< of all strokes
};

}  // namespace riffler::session
