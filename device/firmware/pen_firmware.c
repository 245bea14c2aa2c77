#include "pen_firmware.h"

#include <string.h>

static uint32_t add_saturating(uint32_t a, uint32_t b) {
  return a > UINT32_MAX - b ? UINT32_MAX : a + b;
}

/* --- Configuration ------------------------------------------------------------------------------------------------ */

const char* riffler_pen_config_problem(const riffler_pen_config* config) {
  const char* const problem = riffler_pen_limits_problem(&config->limits);
  if (problem != NULL) return problem;
  uint8_t bytes[RIFFLER_PEN_IDENTITY_SIZE];
  riffler_pen_identity identity;
  riffler_pen_encode_identity(&config->identity, bytes);
  const riffler_pen_result result = riffler_pen_decode_identity(bytes, sizeof bytes, &identity);
  if (result != RIFFLER_PEN_OK) return riffler_pen_result_text(result);
  for (size_t k = 0; k < RIFFLER_PEN_JOINTS; ++k)
    if (config->trip_ma[k] <= config->limits.peak_ma[k] || config->trip_ma[k] > INT16_MAX)
      return "a trip current is not within its peak … 32767 mA";
  if (config->late_us == 0 || config->late_us > config->limits.watchdog_us)
    return "the time of a late step is not within 1 µs … the watchdog's time";
  if (config->mismatch_ma == 0 || config->mismatch_us == 0) return "the current mismatch or its time is 0";
  if (config->hottest_dc < 0 || config->hottest_dc > 1500) return "the hottest temperature is not within 0 … 150 °C";
  return NULL;
}

void riffler_pen_reference_config(riffler_pen_config* config) {
  memset(config, 0, sizeof *config);
  config->identity.major = RIFFLER_PEN_PROTOCOL_MAJOR;
  config->identity.minor = RIFFLER_PEN_PROTOCOL_MINOR;
  config->identity.firmware = 1;
  strcpy(config->identity.geometry, "riffler");
  strcpy(config->identity.serial, "0");
  for (size_t k = 0; k < RIFFLER_PEN_JOINTS; ++k) {
    config->limits.peak_ma[k] = 1500;
    config->limits.continuous_ma[k] = 500;
    config->trip_ma[k] = 2500;
  }
  config->limits.rate_ma_per_ms = 100;
  config->limits.thermal_ms = 10000;
  config->limits.period_us = 1000;
  config->limits.stale_us = 5000;
  config->limits.watchdog_us = 20000;
  config->limits.ramp_us = 500000;
  config->limits.speed_counts_per_s = 400000;
  config->limits.stall_ma = 400;
  config->limits.stall_ms = 2000;
  config->late_us = 5000;
  config->mismatch_ma = 500;
  config->mismatch_us = 20000;
  config->hottest_dc = 850;
}

void riffler_pen_init(riffler_pen_firmware* pen, const riffler_pen_config* config) {
  memset(pen, 0, sizeof *pen);
  pen->config = *config;
  pen->configured = riffler_pen_config_problem(config) == NULL;
  pen->state = RIFFLER_PEN_BOOT;
  pen->fault_joint = RIFFLER_PEN_NO_JOINT;
}

/* --- Reports ------------------------------------------------------------------------------------------------------ */

riffler_pen_result riffler_pen_receive(riffler_pen_firmware* pen, const uint8_t* bytes, size_t size) {
  riffler_pen_link* const link = &pen->link;
  riffler_pen_output report;
  riffler_pen_result result = riffler_pen_decode_output(bytes, size, &report);
  /* A host that was silent for the watchdog's time may start at any number; until then an old number means an old
   * report. */
  if (result == RIFFLER_PEN_OK && link->alive && !riffler_pen_is_newer(report.sequence, link->newest.sequence))
    result = RIFFLER_PEN_OLD_SEQUENCE;
  if (result != RIFFLER_PEN_OK) {
    ++link->refused_count;
    return result;
  }
  link->newest = report;
  link->alive = link->taken = 1;
  if (!report.enable) link->disabled = 1;
  return RIFFLER_PEN_OK;
}

riffler_pen_input riffler_pen_report(riffler_pen_firmware* pen) {
  riffler_pen_input report;
  report.state = pen->state;
  report.sequence = pen->sequence++;
  report.time_us = pen->time_us;
  for (size_t k = 0; k < RIFFLER_PEN_JOINTS; ++k) {
    report.counters[k] = pen->sensors.counters[k];
    report.applied[k] = pen->drive.current_ma[k];
  }
  report.probe = pen->sensors.probe;
  report.buttons = pen->sensors.buttons;
  report.flags = pen->flags;
  report.fault = pen->fault;
  report.fault_joint = pen->fault_joint;
  report.fault_count = pen->fault_count;
  report.refused_count = pen->link.refused_count;
  report.echo_sequence = pen->link.newest.sequence;
  report.echo_time_us = pen->link.newest.time_us;
  return report;
}

size_t riffler_pen_feature(const riffler_pen_config* config, uint8_t id, uint8_t* bytes, size_t capacity) {
  if (id == RIFFLER_PEN_IDENTITY_ID && capacity >= RIFFLER_PEN_IDENTITY_SIZE) {
    riffler_pen_encode_identity(&config->identity, bytes);
    return RIFFLER_PEN_IDENTITY_SIZE;
  }
  if (id == RIFFLER_PEN_LIMITS_ID && capacity >= RIFFLER_PEN_LIMITS_SIZE) {
    riffler_pen_encode_limits(&config->limits, bytes);
    return RIFFLER_PEN_LIMITS_SIZE;
  }
  return 0;
}

/* --- One step ----------------------------------------------------------------------------------------------------- */

/* Updates the age of the newest report, and whether an enabling one would start the ramp. */
static void update_link(riffler_pen_firmware* pen, uint32_t elapsed_us) {
  riffler_pen_link* const link = &pen->link;
  link->age_us = link->taken ? 0 : add_saturating(link->age_us, elapsed_us);
  if (link->age_us >= pen->config.limits.watchdog_us) link->alive = link->armed = 0;
  if (pen->state == RIFFLER_PEN_IDLE && link->disabled) link->armed = 1;
}

static unsigned find_events(const riffler_pen_firmware* pen, const riffler_pen_sensors* sensors,
                            riffler_pen_cause cause) {
  const riffler_pen_link* const link = &pen->link;
  unsigned events = 0;
  if (cause.fault != RIFFLER_PEN_NO_FAULT) events |= RIFFLER_PEN_ON_FAULT;
  if (sensors->ready) events |= RIFFLER_PEN_ON_READY;
  if (link->disabled) events |= RIFFLER_PEN_ON_DISABLE;
  if (link->taken && link->newest.enable && link->armed) events |= RIFFLER_PEN_ON_ENABLE;
  if (pen->ramp_us >= pen->config.limits.ramp_us) events |= RIFFLER_PEN_ON_FULL;
  return events;
}

/* Changes tied to a state transition, and only to that. */
static void enter(riffler_pen_firmware* pen, riffler_pen_state next, riffler_pen_cause cause) {
  const riffler_pen_state last = pen->state;
  pen->state = next;
  if (next == last) return;
  /* If the host already enables when the pen starts, the pen waits for it to disable first. */
  pen->link.armed = next == RIFFLER_PEN_IDLE && last != RIFFLER_PEN_BOOT;
  pen->ramp_us = pen->rate_rest = 0;
  if (!riffler_pen_pushes(next)) {
    memset(pen->quiet_us, 0, sizeof pen->quiet_us);
    pen->eased_us = 0;
  }
  pen->fault = next == RIFFLER_PEN_FAULT ? cause.fault : (uint8_t)RIFFLER_PEN_NO_FAULT;
  pen->fault_joint = next == RIFFLER_PEN_FAULT ? cause.joint : (uint8_t)RIFFLER_PEN_NO_JOINT;
  if (next == RIFFLER_PEN_FAULT) ++pen->fault_count;
}

/* A bridge that may be broken is only switched off: braking through it could short the supply. */
static int brakes(uint8_t fault) {
  return fault != RIFFLER_PEN_DRIVER && fault != RIFFLER_PEN_OVER_CURRENT && fault != RIFFLER_PEN_DRIVE_MISMATCH;
}

riffler_pen_drive riffler_pen_step(riffler_pen_firmware* pen, const riffler_pen_sensors* sensors, uint32_t elapsed_us) {
  riffler_pen_link* const link = &pen->link;
  pen->time_us += elapsed_us;
  update_link(pen, elapsed_us);
  if (pen->state == RIFFLER_PEN_RAMP) pen->ramp_us = add_saturating(pen->ramp_us, elapsed_us);

  const riffler_pen_cause cause = riffler_pen_find_cause(pen, sensors, elapsed_us);
  enter(pen, riffler_pen_next_state(pen->state, find_events(pen, sensors, cause)), cause);
  pen->sensors = *sensors;
  link->taken = link->disabled = 0;

  riffler_pen_warm(pen, elapsed_us);
  pen->flags = 0;
  pen->drive.power = riffler_pen_pushes(pen->state);
  pen->drive.brake = pen->state == RIFFLER_PEN_FAULT && brakes(pen->fault);
  if (pen->drive.power)
    riffler_pen_push(pen, elapsed_us);
  else
    for (size_t k = 0; k < RIFFLER_PEN_JOINTS; ++k) pen->drive.current_ma[k] = 0;
  if (link->alive) pen->flags |= RIFFLER_PEN_FLAG_HOST;
  if (link->armed) pen->flags |= RIFFLER_PEN_FLAG_ARMED;
  if (pen->drive.brake) pen->flags |= RIFFLER_PEN_FLAG_BRAKE;
  return pen->drive;
}
