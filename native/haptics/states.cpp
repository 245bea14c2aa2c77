#include "riffler/haptics/states.hpp"

namespace riffler::haptics {

ForceState next(ForceState state, ForceEvent event) {
  using S = ForceState;
  switch (event) {
    case ForceEvent::SwitchOn:
      return state == S::Off ? S::Homing : state;
    case ForceEvent::Trip:
      return state == S::Off ? S::Off : S::Tripped;
    case ForceEvent::Homed:
      return state == S::Homing ? S::Ready : state;
    case ForceEvent::Press:
      return state == S::Ready ? S::Ramp : state;
    case ForceEvent::Release:
      return lets_force_through(state) ? S::Ready : state;
    case ForceEvent::Risen:
      return state == S::Ramp || state == S::Degraded ? S::Active : state;
    case ForceEvent::Late:
      return state == S::Ramp || state == S::Active ? S::Degraded : state;
    case ForceEvent::Rested:
      return state == S::Tripped ? S::Ready : state;
    case ForceEvent::Reset:
      // Through homing, because the cause of the trip may have cost the device its pose.
      return state == S::Tripped ? S::Homing : state;
  }
  return S::Off;
}

bool lets_force_through(ForceState state) {
  return state == ForceState::Ramp || state == ForceState::Active || state == ForceState::Degraded;
}

bool heals(Cause cause) {
  switch (cause) {
    case Cause::BadTime:
    case Cause::DeviceLate:
    case Cause::Overspeed:
    case Cause::LateTick:
    case Cause::Stale:
    case Cause::NoDeadMan:
    case Cause::None:
      return true;
    default:
      return false;
  }
}

const char* name(ForceState state) {
  static constexpr const char* kNames[kForceStates] = {"off",    "homing",   "ready",  "ramp",
                                                       "active", "degraded", "tripped"};
  return kNames[static_cast<std::size_t>(state)];
}

const char* name(ForceEvent event) {
  static constexpr const char* kNames[kForceEvents] = {"switch on", "homed", "press",  "release", "risen",
                                                       "late",      "trip",  "rested", "reset"};
  return kNames[static_cast<std::size_t>(event)];
}

const char* sentence(Cause cause) {
  switch (cause) {
    case Cause::None:
      return "Nothing is wrong.";
    case Cause::BadTime:
      return "Time went backwards between two ticks; the force comes back by itself.";
    case Cause::NotFinite:
      return "The device's pose or speed was not a number; check its calibration, then reset.";
    case Cause::DeviceFault:
      return "The device reported a fault; see its status, then reset.";
    case Cause::DeviceLate:
      return "The device missed the host for a moment, or was late itself; the force comes back when both keep time.";
    case Cause::NotHomed:
      return "The device lost its home position; home it, then reset.";
    case Cause::Redundancy:
      return "The two arms disagree on the length of the grip, so a counter has lost counts; home the device, then "
             "reset.";
    case Cause::Jump:
      return "The pose jumped further than a hand can move; check the encoders, home the device, then reset.";
    case Cause::Overspeed:
      return "The grip moved faster than is safe; the force comes back when it is slow.";
    case Cause::LateTick:
      return "The loop was held up for too long; the force comes back when it keeps time.";
    case Cause::Stale:
      return "No report came from the device for too long; the force comes back when they do.";
    case Cause::BadWrench:
      return "A wrench that is not a number was to be rendered: a fault of the program; report it, then reset.";
    case Cause::Excess:
      return "A wrench beyond every limit was to be rendered: a fault of the program; report it, then reset.";
    case Cause::NoDeadMan:
      return "The dead-man switch was let go; hold it for force.";
  }
  return "";
}

}  // namespace riffler::haptics
