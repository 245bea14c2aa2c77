// What happens in a tick of the pen while somebody sculpts: checks, the account, the tool, the force, and the word of
// it to those who show and record it.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "riffler/base/ring.hpp"
#include "riffler/haptics/limits.hpp"
#include "riffler/haptics/passivity.hpp"
#include "riffler/haptics/safety.hpp"
#include "riffler/haptics/sculpt_step.hpp"
#include "riffler/haptics/workspace.hpp"
#include "riffler/haptics/wrench_extrapolator.hpp"
#include "riffler/pen/capability.hpp"
#include "riffler/pen/pen_step.hpp"
#include "riffler/session/stroke_sink.hpp"
#include "riffler/session/tile_exchange.hpp"

namespace riffler::session {

struct SculptLoopSettings {
  haptics::SculptSettings sculpt;  ///< of one part: what is recorded is a pose for each tick
  sweep::MoveCarver::Options carving;
  haptics::LimitSettings limits;
  haptics::PassivitySettings passivity;
  haptics::SafetySettings safety;
  haptics::WrenchExtrapolatorSettings wrench_extrapolator;
  haptics::WorkspaceSettings workspace;

  /// std::invalid_argument naming the field.
  void validate() const;
};

/// One tick, as it was. Trivially copyable.
struct SculptTick {
  double time = 0;     ///< s since the loop began
  Pose grip, tool;     ///< at its end; the grip in the device's frame
  Pose from;           ///< the tool at its begin: not where the last one left it where it was placed anew
  Wrench wrench;       ///< on the hand, about the grip's point, device's frame: what the device was told
  Wrench applied;      ///< what it had, as far as it says so; otherwise what it was told a tick before
  Wrench on_tool;      ///< of the material, about the tip, part's frame: what the tool feels; nothing where it is air
  double removed = 0;  ///< mm³; of a session that puts on, what it put on
  double depth = 0;    ///< mm that the tool is at most in what it must not enter
  double energy = 0;   ///< N·mm: of the account
  double dt = 0;       ///< s since the last
  double seconds = 0;  ///< of processor time
  haptics::ForceState state = haptics::ForceState::Off;
  haptics::Cause cause = haptics::Cause::None;
  bool cutting = false;           ///< in a stroke
  bool missed = false;            ///< no step was made, and the force was held over
  const char* problem = nullptr;  ///< why nothing was cut though the hand wanted to, or no step was made
};

/// The tool goes where the hand goes, stays out of the obstacles, and cuts while the dead-man switch is held and every
/// check has passed: from the first move that takes something to the end of that is a stroke. What the hand has to be
/// given is computed in each tick from the volume. Where a step could not be made, the force is held over
/// (WrenchExtrapolator); a step that takes longer than its tick leaves the device with what it had, and the next tick
/// turns from there at a limited rate.
class SculptLoop final : public pen::PenStep {
 public:
  using Place = TileExchange::Place;
  static constexpr std::size_t kTicks = 4096;  ///< that are held for whoever shows them

  /// Validates. `obstacles` and `sink` may be null, and must outlive this. The tool stands at `start` when the hand's
  /// pose is first known, and where it is when that is known again; without a start, where the hand is: then the
  /// device's frame is the part's. std::invalid_argument as MoveCarver.
  SculptLoop(const SculptLoopSettings& settings, const Volume& stock, const Tool& tool,
             const collide::Collider* obstacles, const pen::DeviceCapability& device, const std::optional<Pose>& start,
             StrokeSink* sink = nullptr);
  ~SculptLoop() override;

  /// By the thread of the device. Allocates nothing once it is warm, and waits for nobody.
  haptics::SafeWrench step(const pen::PenSample& sample, double now, double dt) noexcept override;

  // By the thread that shows. None of these waits for longer than a step takes.

  /// What was cut into `shown`, a volume of the same frame that nobody else has changed: all of it where the loop is
  /// not stepped within `patience` s, otherwise what there was after a step that began later than this call. The
  /// tiles' places at the end of `places`.
  TileExchange::Mark show(Volume& shown, std::vector<Place>& places, double patience = 3e-3);
  /// The next tick that was not taken yet; false where there is none.
  bool take(SculptTick& tick) noexcept { return ticks_.take(tick); }
  /// Ticks that nobody had room for.
  std::uint64_t dropped_ticks() const noexcept { return dropped_ticks_.load(); }
  /// The volume is another one of the same frame from now on, and so many strokes were taken back (less than zero) or
  /// brought back. False during a stroke, and then nothing is changed.
  bool replace(const Volume& volume, std::int64_t strokes);
  /// The device's frame, scale and switches. std::invalid_argument; then nothing is changed.
  void set_workspace(const haptics::WorkspaceSettings& settings);

  // By any thread.

  /// Clears a trip with the next tick.
  void reset() noexcept { reset_.store(true); }
  const haptics::TripLog& trips() const noexcept { return safety_.log(); }
  /// Nobody steps any more, and the sink has been told everything. Not while the loop is stepped.
  void finish() noexcept;

 private:
  struct Scene;
  Wrench sculpt(const pen::PenSample& sample, double dt, SculptTick& tick) noexcept;
  void place(Scene& scene, const pen::PenSample& sample) noexcept;
  Wrench follow(Scene& scene, const pen::PenSample& sample, double dt, bool cutting, SculptTick& tick) noexcept;
  Wrench missed(double dt, const char* why, SculptTick& tick) noexcept;
  Wrench rendered(const pen::PenSample& sample, const Wrench& wanted, double dt) noexcept;
  void begin_stroke(double dt) noexcept;
  void end_stroke() noexcept;
  void tell_undo() noexcept;

  SculptLoopSettings settings_;
  pen::DeviceCapability device_;
  StrokeSink* sink_;

  // The device's thread's.
  haptics::Safety safety_;
  haptics::Passivity passivity_;
  haptics::WrenchExtrapolator wrench_extrapolator_;
  Wrench slewed_, held_;  // before the controller, and what was released
  Pose last_grip_;
  Pose last_tool_;
  double time_ = 0, owed_ = 0;  // s; the second since the last step that was made
  bool has_grip_ = false, placed_ = false, absolute_;

  // Whoever's who holds the lock; the device's thread never waits for it.
  std::mutex mutex_;
  std::unique_ptr<Scene> scene_;
  std::uint64_t strokes_ = 0;
  std::int64_t brought_back_ = 0;  // since the sink was told
  bool in_stroke_ = false;

  TileExchange exchange_;
  base::Ring<SculptTick> ticks_{kTicks};
  std::atomic<std::uint64_t> dropped_ticks_{0};
  std::atomic<std::uint32_t> dead_man_mask_;
  std::atomic<bool> reset_{false};
};

}  // namespace riffler::session
