// A recording in the place of a device: the hand of then, at the pace of then.
#pragma once

#include <atomic>
#include <functional>
#include <vector>

#include "riffler/pen/device.hpp"

namespace riffler::pen {

/// As journals have them.
struct RecordedStroke {
  std::vector<Pose> poses;
  std::vector<double> times;  ///< s, one for each pose, never falling
};

/// Button 1 is held during strokes. Between rows the pose moves as a tool does between two poses; between strokes, and
/// after the last, it rests where it was. A stroke whose times begin before the last one's end follows it at once.
class PlaybackPen final : public Pen {
 public:
  /// `speed` times as fast as it was. Throws std::invalid_argument naming the stroke and the row: no strokes, no poses,
  /// not one time for each pose, times that fall or are not finite, axes that are opposite. `clock` for tests.
  explicit PlaybackPen(std::vector<RecordedStroke> strokes, double speed = 1, std::function<double()> clock = nullptr);

  std::string kind() const override { return "recording"; }
  bool in_part_frame() const noexcept override { return true; }
  const DeviceCapability& capability() const noexcept override { return capability_; }
  std::string about() const override;
  /// Begins with the first call.
  PenSample newest() const noexcept override;
  double now() const noexcept override { return clock_(); }
  /// Stopped at the end of the last stroke.
  LinkStatus status() const noexcept override;

  /// s from the first row to the last, at this speed.
  double duration() const noexcept { return rows_.back().time / speed_; }

 private:
  struct Row {
    double time;  // s from the start
    Pose pose;
    bool ends;  // a stroke: the hand is off up to the next row
  };
  double elapsed() const noexcept;

  DeviceCapability capability_;
  std::function<double()> clock_;
  double speed_;
  std::vector<Row> rows_;
  mutable std::atomic<double> start_;
};

}  // namespace riffler::pen
