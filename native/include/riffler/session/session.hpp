// A sculpting session: a device, a tool and a stock. The device's thread cuts; another thread displays.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "riffler/pen/device.hpp"
#include "riffler/session/sculpt_loop.hpp"
#include "riffler/sweep/carve_options.hpp"

namespace riffler::session {

/// Settings of a session.
struct SessionSettings {
  SculptLoopSettings loop{};
  /// Pose of the tool at the start, independent of the hand's. Default: the hand's pose for devices in the part frame
  /// (tablets, mice, recordings); for others 5 mm above the middle of the stock's box.
  std::optional<Pose> start;
  std::size_t undo = 64;  ///< number of strokes that can be undone
  /// Add: the tool adds material within the stock's box. Neither the added material nor the stock is felt, only
  /// obstacles.
  sweep::CarveMode mode = sweep::CarveMode::Remove;

  /// Throws std::invalid_argument naming the field.
  void validate() const;
};

/// What happened between two frames.
struct SessionFrame {
  std::vector<TileExchange::Place> tiles;  ///< changed tiles, each once
  std::vector<SculptTick> ticks;
  std::uint64_t strokes = 0;  ///< strokes begun since the start
  bool in_stroke = false;
  std::uint64_t dropped_ticks = 0;  ///< ticks lost since the start, because frames were too rare
};

/// Functions are for one thread unless stated otherwise.
class Session {
 public:
  /// Validates the settings; throws std::invalid_argument as MoveCarver. A device without force skips the checks of its
  /// motion. `protect`: region that must not change, neither material nor air; the tool does not feel it. A volume of
  /// the stock's frame, or null.
  Session(const Volume& stock, const Tool& tool, std::shared_ptr<pen::Pen> pen,
          std::shared_ptr<const collide::Collider> obstacles, const SessionSettings& settings,
          const Volume* protect = nullptr);
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  /// As stop(), without the final update.
  ~Session();

  /// Sends every stroke to `sink`, which is kept alive. Call it before start().
  void record(std::shared_ptr<StrokeSink> sink);

  /// Starts sculpting, in the device's own thread, or in a thread that polls the device a thousand times a second. Call
  /// it once.
  void start();
  /// Whether the session was started and not stopped.
  bool running() const noexcept;
  /// How the system runs the thread of the steps.
  base::ThreadPriority priority() const;
  /// Stops the device and brings `shown` up to date. If it is not running, only returns
  /// what earlier calls left. If `shown` was changed by something
  /// else, throws as frame(), but the session has stopped all the same, and the next call returns its last ticks.
  SessionFrame stop(Volume& shown);

  /// Brings `shown` up to date: the volume passed at the start, which nothing else may change while the session runs;
  /// otherwise std::runtime_error. Waits for the next step, 3 ms at most. All functions throw in a process forked while
  /// the session ran.
  SessionFrame frame(Volume& shown);

  /// Undoes the last stroke, or the last few if they ended between two frames. Returns how many strokes were undone, 0
  /// if there is none. Throws std::runtime_error during a stroke.
  std::size_t undo(Volume& shown);
  /// Redoes what undo() undid, unless a new stroke has begun.
  std::size_t redo(Volume& shown);

  /// The loop of the running session, or nullptr before start().
  SculptLoop* loop() noexcept;
  pen::Pen& pen() noexcept;

 private:
  struct Core;
  std::unique_ptr<Core> core_;
};

}  // namespace riffler::session
