// The states of the force, the events that change them, and the reasons for which it is taken away.
#pragma once

#include <array>
#include <cstdint>

namespace riffler::haptics {

/// Only Ramp, Active and Degraded let a force through.
enum class ForceState : std::uint8_t {
  Off,       ///< not switched on yet
  Homing,    ///< switched on; the device does not know its pose yet
  Ready,     ///< waiting for the dead-man switch
  Ramp,      ///< the force grows from nothing
  Active,    ///< all of it
  Degraded,  ///< data are late: the force fades, and grows back when they come
  Tripped,   ///< a check failed
};
inline constexpr std::size_t kForceStates = 7;

enum class ForceEvent : std::uint8_t {
  SwitchOn,
  Homed,    ///< the device knows its pose
  Press,    ///< the dead-man switch is held
  Release,  ///< it is not
  Risen,    ///< the gain has reached one
  Late,     ///< data are late
  Trip,     ///< a check failed
  Rested,   ///< every check has passed for a while after a trip that heals by itself
  Reset,    ///< somebody cleared the trip
};
inline constexpr std::size_t kForceEvents = 9;

/// Why the force was taken away. In the order in which checks are made: a tick that fails several is told by the first.
enum class Cause : std::uint8_t {
  None,
  BadTime,      ///< value: dt, s
  NotFinite,    ///< of pose, twist, age or redundancy
  DeviceFault,  ///< value: the device's code
  DeviceLate,   ///< value: the device's code, which only says that host or device was late
  NotHomed,
  Redundancy,  ///< value: mm
  Jump,        ///< value: mm, or rad where the position was steady
  Overspeed,   ///< value: mm/s, or rad/s where the limit on that is passed by more
  LateTick,    ///< value: dt, s
  Stale,       ///< value: age, s
  BadWrench,   ///< not a number or not finite
  Excess,      ///< value: N or N·mm: of what was to be let through; the limits before failed
  NoDeadMan,
};
inline constexpr std::size_t kCauses = 14;

/// The state after an event: the one place where states change.
ForceState next(ForceState state, ForceEvent event);

bool lets_force_through(ForceState state);
/// Whether the force may come back by itself when the cause is gone. Where the device's pose is in doubt it may not.
bool heals(Cause cause);

const char* name(ForceState state);
const char* name(ForceEvent event);
/// A sentence for the screen: what happened, and what to do.
const char* sentence(Cause cause);

}  // namespace riffler::haptics
