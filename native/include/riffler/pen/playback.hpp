// Plays a recording as a device: the recorded hand at the recorded pace.
#pragma once

#include <atomic>
#include <functional>
#include <vector>

#include "riffler/pen/device.hpp"

namespace riffler::pen {

/// Poses and times as stored in a journal.
struct RecordedStroke {
  std::vector<Pose> poses;
  std::vector<double> times;  ///< s, one per pose, non-decreasing
};

/// Button 1 is held during strokes. Between rows the pose moves as a tool does between two poses. Between strokes and
/// after the last one it rests at the last pose. A stroke whose times begin before the end of the previous one follows
/// it immediately.
class PlaybackPen final : public Pen {
 public:
  /// `speed`: factor on the recorded pace. `clock`: replaces the system clock in tests. Throws std::invalid_argument
  /// naming stroke and row: no strokes, no poses, a different number of times than poses, times that decrease or are
  /// not finite, opposite axes.
  explicit PlaybackPen(std::vector<RecordedStroke> strokes, double speed = 1, std::function<double()> clock = nullptr);

  std::string kind() const override { return "recording"; }
  bool in_part_frame() const noexcept override { return true; }
  const DeviceCapability& capability() const noexcept override { return capability_; }
  std::string about() const override;
  /// The first call starts the playback.
  PenSample newest() const noexcept override;
  double now() const noexcept override { return clock_(); }
  /// State Connected, and Stopped after the end of the last stroke.
  LinkStatus status() const noexcept override;

  /// Time from the first row to the last at this speed, s.
  double duration() const noexcept { return rows_.back().time / speed_; }

 private:
  struct Row {
    double time;  // s from the start
    Pose pose;
    bool ends;  // end of a stroke: no button up to the next row
  };
  double elapsed() const noexcept;

  DeviceCapability capability_;
  std::function<double()> clock_;
  double speed_;
  std::vector<Row> rows_;
  mutable std::atomic<double> start_;
};

}  // namespace riffler::pen
