// Who wants to know every move of every stroke, in the thread that makes them.
#pragma once

#include <cstddef>

#include "riffler/geom/pose.hpp"
#include "riffler/haptics/wrench.hpp"

namespace riffler::session {

/// Functions are called in the thread of the device: none may wait or allocate.
class StrokeSink {
 public:
  virtual ~StrokeSink() = default;
  /// Whether a stroke may begin or go on: without room for the next row nothing is cut.
  virtual bool room() noexcept = 0;
  /// s since the session began; the tool stands here.
  virtual void begin(double time, const Pose& tool) noexcept = 0;
  /// It has gone here, taken so much (mm³), and the hand was told to feel this (device's frame, about the grip).
  virtual void row(double time, const Pose& tool, const Wrench& wrench, double removed) noexcept = 0;
  virtual void end() noexcept = 0;
  /// Between strokes: the last `strokes` that count do so no longer (undo), or again (redo).
  virtual void undo(std::size_t strokes) noexcept = 0;
  virtual void redo(std::size_t strokes) noexcept = 0;
};

}  // namespace riffler::session
