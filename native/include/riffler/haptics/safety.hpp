// The safety gate that every force passes. Only this gate makes a SafeWrench from a wrench, and only in a tick in which
// every check has passed; device drivers accept nothing but a SafeWrench.
//
// One tick, with the parts of this folder:
//
//   const ForceState state = safety.observe({.dt = dt, .age = age, .pose = grip, .twist = twist, ...});  // may trip
//   if (!lets_force_through(state)) w = {};
//
//   const auto [linear, angular] = pose_error(grip, last_grip);
//   passivity.observe(applied, {linear, angular}, dt);  // what the motors did since then, as the device reports it
//
//   const auto [on_grip, on_tool, energy] = couple(coupling, pose_error(grip, tool), twist, tool_twist);
//   tool = ...;  // moved by on_tool, or held by a contact
//
//   w = limited(limits, capability, w, on_grip, twist, dt);  // rates: from the last w, not from applied
//   w = passivity.control(w, capability);
//   w = magnitude_gain(limits, w) * w;  // control may have added damping
//
//   device.write(safety.release(w));  // the gain of ramp and fade, and the last checks
//
// `applied` is PenSample::applied. A wrench reaches the motors one or two frames after its release and passes the
// device's own ramps and limits, so an account of released wrenches would be wrong (docs/stability.md). For a device
// that does not report what its motors apply, use the last released wrench.
//
// After `control` a wrench may only shrink, as it does in the last two steps: an account that covers a wrench covers
// any fraction of it. All wrenches and twists of a tick are about the grip's point.
#pragma once

#include <array>

#include "riffler/geom/pose.hpp"
#include "riffler/haptics/settings.hpp"
#include "riffler/haptics/trip_log.hpp"
#include "riffler/haptics/wrench.hpp"

namespace riffler::haptics {

/// Thresholds and times of the safety checks.
struct SafetySettings {
  double ramp = 0.5;                ///< s from zero to full force, at the start and after every interruption
  double fall = 20e-3;              ///< s from full force to zero after the dead-man switch is released
  double fresh = 3e-3;              ///< s: data up to this age, and ticks up to this late, count as fresh
  double fade = 17e-3;              ///< s: after `fresh` the force falls linearly, to zero and a trip at fresh + fade
  double rest = 0.5;                ///< s for which all checks must pass after a self-healing trip
  Bounds overspeed{1000, 20};       ///< mm/s, rad/s
  Bounds jump{3, 0.1};              ///< mm, rad from one tick to the next, in excess of overspeed · dt
  double redundancy = 0.5;          ///< mm of difference between two measurements of one length
  Bounds wrench_ceiling{20, 1200};  ///< N, N·mm: lies above the limits; a larger wrench is a fault

  /// Throws std::invalid_argument naming the field.
  void validate() const;
};

/// Inputs at the start of a tick.
struct Observation {
  double dt = 0;   ///< s since the last tick
  double age = 0;  ///< s since the newest report was measured
  Pose pose{};     ///< of the grip
  Twist twist{};
  double redundancy = 0;      ///< mm; 0 for a device without redundant measurements
  bool homed = false;         ///< the device knows its pose
  bool dead_man = false;      ///< the switch is held
  unsigned device_fault = 0;  ///< the device's code; 0 is none
  bool device_late = false;   ///< the fault only reports that host or device was late
};

/// A wrench that has passed the gate. By default zero, with the gate closed.
class SafeWrench {
 public:
  SafeWrench() = default;
  const Wrench& wrench() const { return wrench_; }
  /// Whether the gate lets force through, even if the wrench is zero: motors may stay switched on.
  bool open() const { return open_; }
  /// Gain of the gate, 0 to 1. A device scales the forces that it adds by itself with it, such as compensation of
  /// weight.
  double gain() const { return gain_; }

 private:
  friend class Safety;
  SafeWrench(const Wrench& w, double gain) : wrench_(w), gain_(gain), open_(true) {}
  Wrench wrench_;
  double gain_ = 0;
  bool open_ = false;
};

/// Checks, force state and gain of one device. One thread calls the functions; any thread may read `log`.
class Safety {
 public:
  /// Throws std::invalid_argument for invalid settings.
  explicit Safety(const SafetySettings& settings);

  /// Runs all checks of the tick, before anything is computed from its data. Returns the state after them.
  ForceState observe(const Observation& now);

  /// `wanted` times the gain. Zero unless `observe` was called since the last release, passed, and lets force through
  /// or a force fall.
  /// A wrench that is not finite or exceeds the ceiling causes a trip, and the result is zero.
  SafeWrench release(const Wrench& wanted);

  void switch_on() { apply(ForceEvent::SwitchOn); }
  /// Clears a trip that does not heal by itself. The device must report itself homed again.
  void reset() { apply(ForceEvent::Reset); }

  /// Marks a gap before the next tick: the hand was not observed meanwhile, so its last pose does not limit the new
  /// one, and the force starts with the ramp. Trips stay.
  void interrupt();

  ForceState state() const { return state_; }
  double gain() const { return gain_; }
  /// The dead-man switch was released, and the last force falls to zero within `fall`: it does not end with a blow. All
  /// other checks continue, and a failed one removes it in the same tick. A press counts only after the fall.
  bool falling() const { return falling_ > 0; }
  /// Cause of the last trip or stop; None once force is let through again.
  Cause cause() const { return cause_; }
  /// Trips, and stops by the dead-man switch. Any thread may read it.
  const TripLog& log() const { return log_; }

 private:
  struct Finding {
    Cause cause;
    double value;
  };
  Finding check(const Observation& now) const;
  Finding check_motion(const Observation& now) const;
  /// Share of the force, 0 to 1, for the age of the data or the lateness of the tick.
  double freshness(const Observation& now) const;
  void apply(ForceEvent event);
  void trip(const Finding& finding);
  void let_go(const Observation& now);
  void rest(double dt);
  void move_gain(double dt, double freshness);
  void fall(double dt, double freshness);

  SafetySettings settings_;
  ForceState state_ = ForceState::Off;
  Cause cause_ = Cause::None;
  double gain_ = 0, falling_ = 0, rested_ = 0, time_ = 0;  // falling_: gain of a force that falls
  bool permitted_ = false, placed_ = false;
  Pose last_{};
  TripLog log_;
};

}  // namespace riffler::haptics
