// A sculpting session: a device, a tool and a stock, cut in the thread of the device and shown in another.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/block_pool.hpp"
#include "base/own_thread.hpp"
#include "pen/device.hpp"
#include "session/masked_stock.hpp"
#include "session/sculpt_loop.hpp"

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
  bool running() const noexcept { return state_ == State::Running; }
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
  SculptLoop* loop() noexcept { return loop_.get(); }
  pen::Pen& pen() noexcept { return *pen_; }

 private:
  enum class State : unsigned char { New, Running, Ended };
  /// The volume between two strokes.
  struct Moment {
    std::uint64_t strokes;  // from the moment before to this one: one, or more where frames came seldom
    Volume volume;
    std::optional<Volume> left{};  // of what may be cut, where that is not the volume itself

    const Volume& cut() const { return left ? *left : volume; }  // the loop's
  };

  std::optional<Pose> start_pose() const;
  void poll() noexcept;
  TileExchange::Mark follow(Volume& shown, std::vector<TileExchange::Place>& places);
  void take_ticks(SessionFrame& frame);
  void look(Volume& shown, SessionFrame& frame);
  std::size_t go_to(Volume& shown, int step, const char* what);
  void note_differences(const Volume& from, const Volume& to);

  SessionSettings settings_;
  Tool tool_;
  std::shared_ptr<pen::Pen> pen_;
  std::shared_ptr<const collide::Collider> obstacles_;
  std::shared_ptr<StrokeSink> sink_;
  std::shared_ptr<SculptLoop> loop_;
  State state_ = State::New;
  base::OwnThread poller_;
  base::HomeProcess home_;
  std::atomic<bool> ending_{false};
  base::BlockReserve reserve_;

  std::optional<MaskedStock> masked_stock_;  // where that is not the volume itself
  std::optional<Volume> left_;               // of it, as it is shown
  std::uint64_t shown_ = 0;                  // revision of the volume that is shown
  std::vector<Moment> moments_;              // between strokes; oldest first
  std::size_t here_ = 0;                     // of them, the one that is shown or being changed
  std::uint64_t strokes_ = 0;                // that were seen
  SessionFrame kept_;                        // for the next
};

}  // namespace riffler::session
