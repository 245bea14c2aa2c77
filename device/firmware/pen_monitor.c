#include "pen_firmware.h"

/* Temperature sensors read beyond these values if their wires are shorted or open. */
enum { COLDEST_DC = -400, BROKEN_DC = 1500 };
/* An overheated motor must cool by this before it may push again. */
enum { COOLING_DC = 100 };
/* Counts by which a joint at rest may flicker within a step, in addition to its speed limit. */
enum { FLICKER_COUNTS = 8 };
/* How long a joint may stay still after its force was reduced to zero: a hand takes about a tenth of a second to
 * move. */
enum { ANSWER_US = 100000 };

static const riffler_pen_cause kNone = {RIFFLER_PEN_NO_FAULT, RIFFLER_PEN_NO_JOINT};

static riffler_pen_cause cause_of(riffler_pen_fault fault, size_t joint) {
  riffler_pen_cause cause;
  cause.fault = (uint8_t)fault;
  cause.joint = (uint8_t)joint;
  return cause;
}

static int64_t magnitude(int64_t value) {
  return value < 0 ? -value : value;
}

static uint32_t grown(uint32_t timer, uint32_t elapsed_us) {
  return timer > UINT32_MAX - elapsed_us ? UINT32_MAX : timer + elapsed_us;
}

/* The lowest joint whose bit is set, or RIFFLER_PEN_NO_JOINT. */
static size_t first_joint(uint8_t bits) {
  for (size_t k = 0; k < RIFFLER_PEN_JOINTS; ++k)
    if (((uint32_t)bits >> k & 1U) != 0) return k;
  return RIFFLER_PEN_NO_JOINT;
}

/* A joint that stands still under force may be held by a quiet hand, and its counter is right; or its encoder is
 * dead, and the force ignores the hand. Both look the same, and the current, which follows from the counts, is
 * the same too. A response distinguishes them: the force is slowly reduced. A hand that held against it then
 * moves, and a count or two later the full force returns. A counter that has not moved when the force is zero is
 * dead, or the joint is at a stop. Heat is no reason to stop a motionless joint: pen_currents.c limits windings
 * to their continuous current, moving or not. */
static void ease(riffler_pen_firmware* pen, uint32_t elapsed_us) {
  int stands = 0;
  for (size_t k = 0; k < RIFFLER_PEN_JOINTS; ++k)
    stands |= pen->quiet_us[k] >= 1000U * (uint32_t)pen->config.limits.stall_ms;
  const uint32_t room = stands ? RIFFLER_PEN_EASE_US - pen->eased_us : pen->eased_us;
  const uint32_t step = elapsed_us < room ? elapsed_us : room;
  pen->eased_us = stands ? pen->eased_us + step : pen->eased_us - step;
}

/* Advances the timers of every joint, even if a fault is found: current differences, joints at rest. */
static void bring_forward(riffler_pen_firmware* pen, const riffler_pen_sensors* sensors, uint32_t elapsed_us) {
  for (size_t k = 0; k < RIFFLER_PEN_JOINTS; ++k) {
    const int32_t told = pen->drive.current_ma[k];
    /* A hand that moves the pen induces a current in shorted windings. */
    const int differs = !pen->drive.brake && magnitude(sensors->current_ma[k] - told) > pen->config.mismatch_ma;
    pen->mismatched_us[k] = differs ? grown(pen->mismatched_us[k], elapsed_us) : 0;
    const int still = sensors->counters[k] == pen->sensors.counters[k];
    const int pushes = magnitude(told) >= pen->config.limits.stall_ma || pen->eased_us > 0;
    pen->quiet_us[k] = still && pushes ? grown(pen->quiet_us[k], elapsed_us) : 0;
  }
  ease(pen, elapsed_us);
}

static riffler_pen_cause find_drive_cause(const riffler_pen_firmware* pen, const riffler_pen_sensors* sensors) {
  if (first_joint(sensors->driver_faults) < RIFFLER_PEN_JOINTS)
    return cause_of(RIFFLER_PEN_DRIVER, first_joint(sensors->driver_faults));
  for (size_t k = 0; k < RIFFLER_PEN_JOINTS; ++k)
    if (magnitude(sensors->current_ma[k]) > pen->config.trip_ma[k]) return cause_of(RIFFLER_PEN_OVER_CURRENT, k);
  for (size_t k = 0; k < RIFFLER_PEN_JOINTS; ++k)
    if (pen->mismatched_us[k] > pen->config.mismatch_us) return cause_of(RIFFLER_PEN_DRIVE_MISMATCH, k);
  return kNone;
}

static riffler_pen_cause find_heat_cause(const riffler_pen_firmware* pen, const riffler_pen_sensors* sensors) {
  const int was_hot = pen->fault == RIFFLER_PEN_OVER_TEMPERATURE;
  const int hottest = pen->config.hottest_dc - (was_hot ? COOLING_DC : 0);
  for (size_t k = 0; k < RIFFLER_PEN_JOINTS; ++k)
    if (sensors->temperature_dc[k] < COLDEST_DC || sensors->temperature_dc[k] > BROKEN_DC)
      return cause_of(RIFFLER_PEN_TEMPERATURE_SENSOR, k);
  for (size_t k = 0; k < RIFFLER_PEN_JOINTS; ++k)
    if (sensors->temperature_dc[k] > hottest) return cause_of(RIFFLER_PEN_OVER_TEMPERATURE, k);
  return kNone;
}

static riffler_pen_cause find_encoder_cause(const riffler_pen_firmware* pen, const riffler_pen_sensors* sensors,
                                            uint32_t elapsed_us) {
  if (first_joint(sensors->encoder_errors) < RIFFLER_PEN_JOINTS)
    return cause_of(RIFFLER_PEN_ENCODER_SIGNAL, first_joint(sensors->encoder_errors));
  const int64_t most = (int64_t)pen->config.limits.speed_counts_per_s * elapsed_us / 1000000 + FLICKER_COUNTS;
  for (size_t k = 0; k < RIFFLER_PEN_JOINTS; ++k)
    if (magnitude(riffler_pen_counts_between(sensors->counters[k], pen->sensors.counters[k])) > most)
      return cause_of(RIFFLER_PEN_ENCODER_JUMP, k);
  return kNone;
}

static riffler_pen_cause find_pushing_cause(const riffler_pen_firmware* pen, uint32_t elapsed_us) {
  const uint32_t longest = 1000U * (uint32_t)pen->config.limits.stall_ms + RIFFLER_PEN_EASE_US + ANSWER_US;
  for (size_t k = 0; k < RIFFLER_PEN_JOINTS; ++k)
    if (pen->quiet_us[k] >= longest) return cause_of(RIFFLER_PEN_STALL, k);
  if (elapsed_us > pen->config.late_us) return cause_of(RIFFLER_PEN_LATE_STEP, RIFFLER_PEN_NO_JOINT);
  if (!pen->link.alive) return cause_of(RIFFLER_PEN_WATCHDOG, RIFFLER_PEN_NO_JOINT);
  return kNone;
}

riffler_pen_cause riffler_pen_find_cause(riffler_pen_firmware* pen, const riffler_pen_sensors* sensors,
                                         uint32_t elapsed_us) {
  bring_forward(pen, sensors, elapsed_us);
  /* Faults that only a restart clears. */
  if (!pen->configured) return cause_of(RIFFLER_PEN_CONFIGURATION, RIFFLER_PEN_NO_JOINT);
  if ((unsigned)pen->state >= RIFFLER_PEN_STATES || pen->fault == RIFFLER_PEN_INTERNAL)
    return cause_of(RIFFLER_PEN_INTERNAL, RIFFLER_PEN_NO_JOINT);
  if (pen->state == RIFFLER_PEN_BOOT) return kNone;
  if (sensors->stopped) return cause_of(RIFFLER_PEN_EMERGENCY_STOP, RIFFLER_PEN_NO_JOINT);
  riffler_pen_cause cause = find_drive_cause(pen, sensors);
  if (cause.fault == RIFFLER_PEN_NO_FAULT) cause = find_heat_cause(pen, sensors);
  if (cause.fault == RIFFLER_PEN_NO_FAULT) cause = find_encoder_cause(pen, sensors, elapsed_us);
  if (cause.fault == RIFFLER_PEN_NO_FAULT && riffler_pen_pushes(pen->state))
    cause = find_pushing_cause(pen, elapsed_us);
  return cause;
}
