// Force states, the events that change them, and the causes of a trip or stop.
#pragma once

#include <array>
#include <cstdint>

namespace riffler::haptics {

/// Only Ramp, Active and Degraded let force through.
enum class ForceState : std::uint8_t {
  Off,       ///< not switched on yet
  Homing,    ///< switched on; the device does not know its pose yet
  Ready,     ///< waiting for the dead-man switch
  Ramp,      ///< the force grows from zero
  Active,    ///< full force
  Degraded,  ///< data are late: the force fades, and returns with fresh data
  Tripped,   ///< a check failed
};
inline constexpr std::size_t kForceStates = 7;

/// Events that change the force state.
enum class ForceEvent : std::uint8_t {
  SwitchOn,
  Homed,    ///< the device knows its pose
  Press,    ///< the dead-man switch is held
  Release,  ///< the dead-man switch is released
  Risen,    ///< the gain has reached one
  Late,     ///< data are late
  Trip,     ///< a check failed
  Rested,   ///< every check has passed for a while after a self-healing trip
  Reset,    ///< the user cleared the trip
};
inline constexpr std::size_t kForceEvents = 9;

/// Why the force was taken away, in the order of the checks: a tick that fails several reports the first.
enum class Cause : std::uint8_t {
  None,
  BadTime,      ///< value: dt, s
  NotFinite,    ///< pose, twist, age or redundancy
  DeviceFault,  ///< value: the device's code
  DeviceLate,   ///< value: the device's code, which reports only that host or device was late
  NotHomed,
  Redundancy,  ///< value: mm
  Jump,        ///< value: mm, or rad if only the orientation jumped
  Overspeed,   ///< value: mm/s or rad/s, of the bound exceeded by the larger factor
  LateTick,    ///< value: dt, s
  Stale,       ///< value: age, s
  BadWrench,   ///< the wrench is not finite
  Excess,      ///< value: N or N·mm of the wanted wrench; an earlier limit failed
  NoDeadMan,
};
inline constexpr std::size_t kCauses = 14;

/// The state after an event. The only place where states change.
ForceState next(ForceState state, ForceEvent event);

/// Whether the state is Ramp, Active or Degraded.
bool lets_force_through(ForceState state);
/// Whether the force may return by itself when the cause is gone. It may not where the device's pose is in doubt.
bool heals(Cause cause);

/// Names for logs and scripts: "off", "homed", …
const char* name(ForceState state);
const char* name(ForceEvent event);
/// A sentence for the screen: what happened and what to do.
const char* sentence(Cause cause);

}  // namespace riffler::haptics
