// A sculpting session: a device, a tool and a stock, cut in the thread of the device and shown in another.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "riffler/pen/device.hpp"
#include "riffler/session/sculpt_loop.hpp"
#include "riffler/sweep/carve_options.hpp"

namespace riffler::session {

struct SessionSettings {
  SculptLoopSettings loop{};
  /// Where the tool stands when the session starts, whatever the hand's pose is then; without it, where the hand is for
  /// devices whose poses are in the part's frame (tablets, mice, recordings), and for others 5 mm above the middle of
  /// the stock's box.
  std::optional<Pose> start;
  std::size_t undo = 64;  ///< strokes that can be taken back
  /// Add: the tool puts material on, within the stock's box. Nothing of that is felt, nor is the stock: only obstacles
  /// are.
  sweep::CarveMode mode = sweep::CarveMode::Remove;

  /// std::invalid_argument naming the field.
  void validate() const;
};

/// What happened between two looks.
struct SessionFrame {
  std::vector<TileExchange::Place> tiles;  ///< that changed, each once
  std::vector<SculptTick> ticks;
  std::uint64_t strokes = 0;  ///< that were begun since the start
  bool in_stroke = false;
  std::uint64_t dropped_ticks = 0;  ///< ticks since the start that are missing in frames: they came too seldom
};

/// Functions are for one thread, if nothing else is said.
class Session {
 public:
  /// Validates; std::invalid_argument as MoveCarver. A device without force is spared the checks of its motion. What
  /// lies in `protect`, a volume of the stock's frame or null, stays as it is, material and air, and is as air to the
  /// tool.
  Session(const Volume& stock, const Tool& tool, std::shared_ptr<pen::Pen> pen,
          std::shared_ptr<const collide::Collider> obstacles, const SessionSettings& settings,
          const Volume* protect = nullptr);
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  /// As stop(), but for what was not shown yet.
  ~Session();

  /// Every stroke goes there. Before start(); `sink` is kept.
  void record(std::shared_ptr<StrokeSink> sink);

  /// The device's thread sculpts from now on: its own, or one that asks it a thousand times a second. Once.
  void start();
  bool running() const noexcept;
  /// The device does not push any more, and everything that was cut is in `shown`. Nothing where it does not run. As
  /// frame() for a volume that was changed by something else, but the session has stopped all the same: the next call
  /// gives its last ticks.
  SessionFrame stop(Volume& shown);

  /// Brings `shown` up to date: the volume of the start, which nobody else changes while the session runs; otherwise
  /// std::runtime_error. In a process that was forked while the session ran, all of these throw. Waits for the next
  /// step, 3 ms at most.
  SessionFrame frame(Volume& shown);

  /// The last stroke, or the last few that ended between two frames, did not happen. How many that were: 0 where there
  /// is none. Throws std::runtime_error in the middle of a stroke.
  std::size_t undo(Volume& shown);
  /// And happened, unless another was begun since.
  std::size_t redo(Volume& shown);

  /// As of SculptLoop. nullptr before start().
  SculptLoop* loop() noexcept;
  pen::Pen& pen() noexcept;

 private:
  struct Core;
  std::unique_ptr<Core> core_;
};

}  // namespace riffler::session
