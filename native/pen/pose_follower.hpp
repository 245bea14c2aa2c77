// Leads the grip along a path of poses with the motors and records counters and currents: the motion of an
// identification (docs/pen-geometry.md).
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "riffler/haptics/coupling.hpp"
#include "riffler/haptics/limits.hpp"
#include "riffler/haptics/safety.hpp"
#include "riffler/pen/arms/kinematics.hpp"
#include "riffler/pen/capability.hpp"
#include "riffler/pen/pen_step.hpp"

namespace riffler::pen {

/// A point of the path. Between two points the pose moves along the quintic of least jerk, at rest at both.
struct FollowerKey {
  double time = 0;  ///< s since the first key; increasing
  Pose pose{};
  Wrench extra{};  ///< N, N·mm about the pivot, in addition to all others; linear between keys
};

struct FollowerSettings {
  /// Between the grip and its target. All zero: the grip is not led, and only `extra` acts.
  haptics::CouplingSettings coupling{0.3, 5e-3, 150, 2, 5, 0.5};
  haptics::Bounds astray{15, 0.5};  ///< mm, rad: further from the target, the motion stops
  double gravity = 1;               ///< share of the described weight that the motors carry
  double weight = 0, hook = 0;      ///< N that hangs on the grip, mm from the pivot towards the tool's tip
  double silence = 0.5;             ///< s on the host's clock without alive(), after which the motion stops

  /// Throws std::invalid_argument naming the field.
  void validate() const;
};

/// Stopped is final. Holding: the path has ended, and the grip is held at its end.
enum class FollowerState : unsigned char { Waiting, Ramp, Moving, Holding, Stopped };
enum class FollowerStop : unsigned char { None, Asked, Silent, Astray, Safety };
const char* name(FollowerState state) noexcept;

/// One report during the motion.
struct FollowerRecord {
  std::uint64_t sequence = 0;  ///< number of the report
  double time = 0;             ///< s on the path
  std::array<std::int32_t, kPenChannels> counts{};
  std::array<std::int16_t, kPenChannels> currents{};  ///< mA, applied
};

/// All forces pass limits and the safety gate, whose dead-man switch is alive(): the program that started the motion
/// has to call it again and again. Every trip of the gate ends the motion for good.
class PoseFollower final : public PenStep {
 public:
  /// Throws std::invalid_argument for invalid settings or keys: at least one key, finite, times increasing, unit axes.
  PoseFollower(const PenGeometry& geometry, std::vector<FollowerKey> keys, const FollowerSettings& settings);

  /// Any thread.
  void alive() noexcept;
  void stop() noexcept { asked_to_stop_.store(true); }
  FollowerState state() const noexcept { return state_.load(); }
  FollowerStop reason() const noexcept { return reason_.load(); }
  haptics::Cause cause() const noexcept { return cause_.load(); }
  /// s on the path.
  double time() const noexcept { return shown_time_.load(); }
  /// A copy of the records so far.
  std::vector<FollowerRecord> records() const;

  haptics::SafeWrench step(const PenSample& sample, double now, double dt) noexcept override;

 private:
  struct Target {
    Pose pose;
    Twist twist;
    Wrench extra;
  };
  Target target() noexcept;
  bool leads() const noexcept { return settings_.coupling.stiffness > 0; }
  Wrench wanted(const PenSample& sample, const Target& target, const PenPosture& posture) const noexcept;
  bool astray(const PenSample& sample, const Target& target) const noexcept;
  void end(FollowerStop reason) noexcept;
  void record(const PenSample& sample) noexcept;

  PenKinematics pen_;
  std::vector<FollowerKey> keys_;
  FollowerSettings settings_;
  DeviceCapability capability_;
  haptics::LimitSettings limits_;
  haptics::Safety safety_;
  Wrench last_{};
  double time_ = 0;
  std::size_t key_ = 0;
  bool opened_ = false;  // the gate has let force through
  std::vector<FollowerRecord> records_;
  std::atomic<std::size_t> recorded_{0};
  std::uint64_t sequence_ = 0;
  std::atomic<double> heard_, shown_time_{0};
  std::atomic<bool> asked_to_stop_{false};
  std::atomic<FollowerState> state_{FollowerState::Waiting};
  std::atomic<FollowerStop> reason_{FollowerStop::None};
  std::atomic<haptics::Cause> cause_{haptics::Cause::None};
};

}  // namespace riffler::pen
