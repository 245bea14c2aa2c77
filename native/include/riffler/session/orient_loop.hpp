// One tick of orienting a tool by hand: the cutter stays on a path, the axis follows the hand, and shank and holder are
// held by what they touch.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>

#include "riffler/base/ring.hpp"
#include "riffler/haptics/sculpt_step.hpp"
#include "riffler/haptics/workspace.hpp"
#include "riffler/session/path_guide.hpp"
#include "riffler/session/pen_loop.hpp"

namespace riffler::session {

/// Settings of the loop, by component.
struct OrientSettings {
  OrientSettings();  ///< a weak coupling to the path, a strong one to the axis; no dead-man switch: its button sets
                     ///< keys

  haptics::SculptSettings step;  ///< must have one part
  haptics::LimitSettings limits;
  haptics::PassivitySettings passivity;
  haptics::SafetySettings safety;
  haptics::WrenchExtrapolatorSettings wrench_extrapolator;
  haptics::WorkspaceSettings workspace;
  std::uint32_t set_mask = 1;     ///< any of these buttons sets a key
  std::uint32_t delete_mask = 2;  ///< any of these buttons deletes one
  bool slides = true;             ///< the tool follows the hand along the path; false: it rests at its point

  /// Throws std::invalid_argument naming the field.
  void validate() const;
};

/// Record of one tick. Trivially copyable.
struct OrientTick {
  double time = 0;     ///< s since the start of the loop
  Pose grip, tool;     ///< at the end of the tick; the grip in the device frame
  double station = 0;  ///< place on the path: a point index with a fraction
  Wrench wrench;       ///< on the hand, about the grip's point, device frame: as sent to the device
  Wrench on_tool;      ///< of part and fixtures, about the tip, part frame
  double depth = 0;    ///< mm: upper bound of the tool's depth in part and fixtures
  double energy = 0;   ///< N·mm: balance of the energy account
  double dt = 0;       ///< s since the last tick
  double seconds = 0;  ///< s of processor time
  haptics::ForceState state = haptics::ForceState::Off;
  haptics::Cause cause = haptics::Cause::None;
  std::optional<collide::Touch> touch;  ///< what is deepest in contact
  bool missed = false;                  ///< no step was made; the force was extrapolated
  bool held = false;                    ///< the tool did not move: its depth was not found in time
  const char* problem = nullptr;        ///< why the tool does not follow
};

/// A button was pressed.
struct KeyPress {
  double time = 0;     ///< s since the start of the loop
  double station = 0;  ///< place on the path
  Vec3 axis{0, 0, 1};  ///< of the tool
  bool deletes = false;
};

/// The loop of an OrientSession. The force is the pull of a spring between hand and tool: the tool stands on the path,
/// and its axis stops where shank, holder or cutter touch. Devices without torque get the contact's force instead.
class OrientLoop final : public PenLoop<OrientTick> {
 public:
  static constexpr std::size_t kPresses = 64;  ///< capacity of the queue of presses for the display

  /// Validates the settings. `obstacles` must outlive this object. `absolute`: the tool's first axis is that of the
  /// hand; otherwise it keeps that of `guide` and turns with the hand from there.
  OrientLoop(const OrientSettings& settings, const Tool& tool, const PathGuide& guide,
             const collide::Collider& obstacles, const pen::DeviceCapability& device, bool absolute);
  ~OrientLoop() override;

  /// By the thread of the device. After warm-up it neither allocates nor waits.
  haptics::SafeWrench step(const pen::PenSample& sample, double now, double dt) noexcept override;

  // By the displaying thread. None of these waits longer than one step takes.

  using PenLoop::take;
  /// The next press not taken yet; false if there is none.
  bool take(KeyPress& press) noexcept { return presses_.take(press); }
  /// Number of presses lost because the queue was full.
  std::uint64_t dropped_presses() const noexcept { return dropped_presses_.load(); }
  /// Moves the tool to a point of the path. Throws std::invalid_argument and then changes nothing.
  void go_to(std::size_t point);
  void set_slides(bool slides);
  /// Sets frame, scale and clutch of the device. Throws std::invalid_argument and then changes nothing.
  void set_workspace(const haptics::WorkspaceSettings& settings);

 private:
  struct Scene;
  Wrench follow(const pen::PenSample& sample, double dt, OrientTick& tick) noexcept;
  void press(std::uint32_t buttons, const OrientTick& tick) noexcept;

  OrientSettings settings_;
  bool torque_;  // the device renders some

  // Used by the device's thread only.
  std::uint32_t buttons_ = ~0u;  // of the last tick; a button held at the start is not a press
  double last_station_ = 0;

  std::mutex mutex_;  // of the scene; the device's thread only tries to lock it
  std::unique_ptr<Scene> scene_;

  base::Ring<KeyPress> presses_{kPresses};
  std::atomic<std::uint64_t> dropped_presses_{0};
};

}  // namespace riffler::session
