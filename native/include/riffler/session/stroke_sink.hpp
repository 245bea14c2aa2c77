// Observer of strokes, called in the sculpting thread for every move.
#pragma once

#include <cstddef>

#include "riffler/geom/pose.hpp"
#include "riffler/haptics/wrench.hpp"

namespace riffler::session {

/// The device's thread calls these functions: none may wait or allocate.
class StrokeSink {
 public:
  virtual ~StrokeSink() = default;
  /// Whether a stroke may begin or continue. Nothing is cut without room for the next row.
  virtual bool room() noexcept = 0;
  /// A stroke begins. `time`: s since the start of the session; `tool`: its first pose.
  virtual void begin(double time, const Pose& tool) noexcept = 0;
  /// The tool moved to `tool` and removed `removed` mm³; `wrench` was sent to the device (device frame, about the
  /// grip).
  virtual void row(double time, const Pose& tool, const Wrench& wrench, double removed) noexcept = 0;
  /// The stroke ends.
  virtual void end() noexcept = 0;
  /// Between strokes: the last `strokes` strokes are undone, or redone.
  virtual void undo(std::size_t strokes) noexcept = 0;
  virtual void redo(std::size_t strokes) noexcept = 0;
};

}  // namespace riffler::session
