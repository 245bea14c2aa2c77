// One tick of sculpting: safety checks, energy account, tool motion and force, and the hand-over to the threads that
// display and record.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "riffler/haptics/limits.hpp"
#include "riffler/haptics/passivity.hpp"
#include "riffler/haptics/safety.hpp"
#include "riffler/haptics/sculpt_step.hpp"
#include "riffler/haptics/workspace.hpp"
#include "riffler/pen/capability.hpp"
#include "riffler/session/pen_loop.hpp"
#include "riffler/session/stroke_sink.hpp"
#include "riffler/session/tile_exchange.hpp"

namespace riffler::session {

/// Settings of a sculpting loop, by component.
struct SculptLoopSettings {
  haptics::SculptSettings sculpt;  ///< must have one part, since one pose is recorded per tick
  sweep::MoveCarver::Options carving;
  haptics::LimitSettings limits;
  haptics::PassivitySettings passivity;
  haptics::SafetySettings safety;
  haptics::WrenchExtrapolatorSettings wrench_extrapolator;
  haptics::WorkspaceSettings workspace;
  /// While no button of the dead-man mask is held, the stock is an obstacle, and the hand feels it with `touch_force`
  /// (N) at most, and a torque limited in proportion.
  bool touch = false;
  double touch_force = 1.5;
  std::uint32_t touch_mask = 0;  ///< buttons of which one must be held for that; 0: none

  /// Throws std::invalid_argument naming the field.
  void validate() const;
};

/// Record of one tick. Trivially copyable.
struct SculptTick {
  double time = 0;     ///< s since the start of the loop
  Pose grip, tool;     ///< at the end of the tick; the grip in the device frame
  Pose from;           ///< tool at the start of the tick; differs from the last tick's `tool` after a new placement
  Wrench wrench;       ///< on the hand, about the grip's point, device frame: as sent to the device
  Wrench applied;      ///< as applied, if the device reports it; otherwise as sent one tick before
  Wrench on_tool;      ///< of the material, about the tip, part frame; zero in air
  double removed = 0;  ///< mm³ removed; added in a session that adds
  double depth = 0;    ///< mm: upper bound of the tool's depth in obstacles
  double energy = 0;   ///< N·mm: balance of the energy account
  double dt = 0;       ///< s since the last tick
  double seconds = 0;  ///< s of processor time
  haptics::ForceState state = haptics::ForceState::Off;
  haptics::Cause cause = haptics::Cause::None;
  bool cutting = false;           ///< in a stroke
  bool missed = false;            ///< no step was made; the force was extrapolated
  bool held = false;              ///< the tool did not move: the depth in the obstacles was not found in time
  const char* problem = nullptr;  ///< why nothing was cut despite the request, or why no step was made
};

/// The tool follows the hand, stays out of the obstacles, and cuts while the dead-man switch is held and every check
/// has passed. With `touch` the button only cuts: without it the tool stays out of the stock. A stroke lasts from the
/// first move that removes something to the end of that condition. The force is computed in each tick from the volume.
/// If a step cannot be made, WrenchExtrapolator continues the force. If a step takes longer than its tick, the device
/// keeps its last wrench, and the next tick turns from there at a limited rate.
class SculptLoop final : public PenLoop<SculptTick> {
 public:
  using Place = TileExchange::Place;

  /// Validates the settings. `obstacles` and `sink` may be null, and must outlive this object. `start`: pose of the
  /// tool when the hand's pose is first known; when the hand's pose returns after a loss, the tool continues where it
  /// is. Without a start the tool stands at the hand, and the device frame is the part frame. Throws
  /// std::invalid_argument as MoveCarver.
  SculptLoop(const SculptLoopSettings& settings, const Volume& stock, const Tool& tool,
             const collide::Collider* obstacles, const pen::DeviceCapability& device, const std::optional<Pose>& start,
             StrokeSink* sink = nullptr);
  ~SculptLoop() override;

  /// By the thread of the device. After warm-up it neither allocates nor waits.
  haptics::SafeWrench step(const pen::PenSample& sample, double now, double dt) noexcept override;

  // By the displaying thread. `show` waits for up to twenty steps, the others no longer than one step takes.

  /// Copies what was cut into `shown`, a volume of the same frame that nothing else changes. If the loop makes no step
  /// within `patience` (s), copies everything cut so far; otherwise the state after a step that began later than this
  /// call; the steps after that one prepare the tiles, a part each. Appends the places of the changed tiles to
  /// `places`.
  TileExchange::Mark show(Volume& shown, std::vector<Place>& places, double patience = 3e-3);
  /// Replaces the volume by another of the same frame. `strokes`: number of strokes undone (negative) or redone
  /// (positive) by that. During a stroke returns false and changes nothing.
  bool replace(const Volume& volume, std::int64_t strokes);
  /// Sets frame, scale and switches of the device. Throws std::invalid_argument and then changes nothing.
  void set_workspace(const haptics::WorkspaceSettings& settings);

  /// Ends the last stroke and informs the sink. By any thread, after the last step.
  void finish() noexcept;
  /// Number of steps in which the tool did not move (SculptTick::held). By any thread.
  std::uint64_t held_steps() const noexcept { return held_steps_.load(std::memory_order_relaxed); }

 private:
  struct Scene;
  Wrench sculpt(const pen::PenSample& sample, double dt, SculptTick& tick) noexcept;
  void place(Scene& scene, const pen::PenSample& sample) noexcept;
  Wrench follow(Scene& scene, const pen::PenSample& sample, double dt, bool cutting, SculptTick& tick) noexcept;
  bool serve(Scene& scene);
  void begin_stroke(double dt) noexcept;
  void end_stroke() noexcept;
  void tell_undo() noexcept;
  std::uint32_t force_mask() const noexcept;
  Wrench limited_touch(const Wrench& on_hand, double dt, bool cutting) noexcept;

  SculptLoopSettings settings_;
  StrokeSink* sink_;

  // Protected by the mutex; the device's thread only tries to lock it.
  std::mutex mutex_;
  std::unique_ptr<Scene> scene_;
  std::uint64_t strokes_ = 0;
  std::int64_t brought_back_ = 0;  // not reported to the sink yet
  bool in_stroke_ = false;
  bool unpublished_ = false;  // the carver has cut since it last published
  double touch_share_;        // of the limits of force and torque, 0 to 1

  TileExchange exchange_;
  TileExchange::Mark serving_;            // of the state that is being prepared
  std::atomic<std::uint32_t> served_{0};  // parts of states prepared
  std::atomic<std::uint32_t> dead_man_mask_;
  std::atomic<std::uint64_t> held_steps_{0};
};

}  // namespace riffler::session
