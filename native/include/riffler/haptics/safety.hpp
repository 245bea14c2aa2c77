// The gate through which every force goes. A wrench becomes a SafeWrench here or nowhere, and only in a tick in which
// every check has passed; whoever drives a device takes a SafeWrench and nothing else.
//
// One tick, with the parts of this folder:
//
//   const ForceState state = safety.observe({.dt = dt, .age = age, .pose = grip, .twist = twist, ...});  // may trip
//   if (!lets_force_through(state)) w = {};
//
//   const auto [way, turn] = stretch(grip, last_grip);
//   passivity.observe(applied, {way, turn}, dt);  // what the motors did since, by the device's own word
//
//   const auto [on_grip, on_tool, energy] = couple(coupling, stretch(grip, tool), twist, tool_twist);
//   tool = ...;  // goes where on_tool takes it, or is held by what it touches
//
//   w = limited(limits, capability, w, on_grip, twist, dt);  // rates: from the last w, not from applied
//   w = passivity.control(w, capability);
//   w = magnitude_gain(limits, w) * w;  // damping was added
//
//   device.write(safety.release(w));  // the gain of ramp and fade, the last checks
//
// `applied` is PenSample::applied: a wrench comes to the motors one or two frames after it was released, behind ramps
// and limits of the device's own, and an account of what was released is deceived (docs/stability.md). Of a device that
// does not say what its motors have, the last released wrench is the nearest thing.
//
// After `control` a wrench may only shrink, as it does in the last two steps: the account that bears a wrench bears
// any part of it. All wrenches and twists of a tick are about the grip's point.
#pragma once

#include <array>

#include "riffler/geom/pose.hpp"
#include "riffler/haptics/settings.hpp"
#include "riffler/haptics/trip_log.hpp"
#include "riffler/haptics/wrench.hpp"

namespace riffler::haptics {

struct SafetySettings {
  double ramp = 0.5;           ///< s from nothing to all of the force, at the start and after every interruption
  double fresh = 3e-3;         ///< s: data of this age, and ticks this late, are as good as new
  double fade = 17e-3;         ///< s: then the force falls on a straight line, to nothing and a trip at fresh + fade
  double rest = 0.5;           ///< s for which all checks must pass after a trip that heals by itself
  Bounds overspeed{1000, 20};  ///< mm/s, rad/s
  Bounds jump{3, 0.1};         ///< mm, rad from one tick to the next, beyond overspeed · dt
  double redundancy = 0.5;     ///< mm between two measurements of one length
  Bounds wrench_ceiling{20, 1200};  ///< N, N·mm: above the limits; a wrench over it is a fault

  /// std::invalid_argument naming the field.
  void validate() const;
};

/// What is known at the start of a tick.
struct Observation {
  double dt = 0;   ///< s since the last tick
  double age = 0;  ///< s since the newest report was measured
  Pose pose{};     ///< of the grip
  Twist twist{};
  double redundancy = 0;      ///< mm; 0 for a device that measures nothing twice
  bool homed = false;         ///< the device knows its pose
  bool dead_man = false;      ///< the switch is held
  unsigned device_fault = 0;  ///< the device's code; 0 is none
  bool device_late = false;   ///< that fault says nothing against the device: somebody was late
};

/// A wrench that has passed the gate. The default is zero, and a closed gate.
class SafeWrench {
 public:
  SafeWrench() = default;
  const Wrench& wrench() const { return wrench_; }
  /// Whether the gate lets force through, if only nothing was asked for: motors may stay switched on.
  bool open() const { return open_; }
  /// Of the gate, 0 to 1: for what a device adds by its own knowledge, as the weight of its arms.
  double gain() const { return gain_; }

 private:
  friend class Safety;
  SafeWrench(const Wrench& w, double gain) : wrench_(w), gain_(gain), open_(true) {}
  Wrench wrench_;
  double gain_ = 0;
  bool open_ = false;
};

class Safety {
 public:
  /// Validates the settings.
  explicit Safety(const SafetySettings& settings);

  /// All checks of the tick, before anything is computed from its data. Returns the state after them.
  ForceState observe(const Observation& now);

  /// `wanted` times the gain; zero unless `observe` was called since the last release, passed, and lets force through.
  /// A wrench that is not finite or over the ceiling trips, and is zero.
  SafeWrench release(const Wrench& wanted);

  void switch_on() { apply(ForceEvent::SwitchOn); }
  /// Clears a trip that does not heal by itself; the device must report itself homed again.
  void reset() { apply(ForceEvent::Reset); }

  /// The tick to come has none before it: nobody watched the hand meanwhile, so where it was is no measure of where it
  /// may be, and the force begins with the ramp. Trips stay.
  void interrupt();

  ForceState state() const { return state_; }
  double gain() const { return gain_; }
  /// Of the last trip or stop; None once force is let through again.
  Cause cause() const { return cause_; }
  /// Trips, and stops by the dead-man switch. To be read by other threads.
  const TripLog& log() const { return log_; }

 private:
  struct Finding {
    Cause cause;
    double value;
  };
  Finding check(const Observation& now) const;
  Finding check_motion(const Observation& now) const;
  /// In [0, 1]: what the age of the data, or the lateness of the tick, leaves.
  double freshness(const Observation& now) const;
  void apply(ForceEvent event);
  void trip(const Finding& finding);
  void let_go(const Observation& now);
  void rest(double dt);
  void move_gain(double dt, double freshness);

  SafetySettings settings_;
  ForceState state_ = ForceState::Off;
  Cause cause_ = Cause::None;
  double gain_ = 0, rested_ = 0, time_ = 0;
  bool permitted_ = false, placed_ = false;
  Pose last_{};
  TripLog log_;
};

}  // namespace riffler::haptics
