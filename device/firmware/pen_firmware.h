/* Reference logic of a pen's firmware: from reports and sensors to motor commands.
 *
 * Everything is a function of (state, inputs, elapsed µs), without clock, interrupts, allocation or floating
 * point. The same code therefore runs in the pen and, on a virtual clock, in the host's tests and simulated pen.
 * pen_board.h connects it to hardware. The order within a step: age of the newest command, causes of a fault,
 * next state, currents.
 *
 * Force requires a report that disables followed by one that enables, a continuing stream of reports, and no
 * fault. In the step that finds a fault, the currents are already 0. Times are in µs, currents in mA,
 * temperatures in tenths of °C. */
#ifndef RIFFLER_DEVICE_FIRMWARE_PEN_FIRMWARE_H
#define RIFFLER_DEVICE_FIRMWARE_PEN_FIRMWARE_H

#include "pen_states.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Identity and limits of the pen. The limits are reported to the host; only the firmware needs the rest. */
typedef struct riffler_pen_config {
  riffler_pen_identity identity;
  riffler_pen_limits limits;
  uint32_t late_us;                     /* a longer step while pushing is a fault */
  uint16_t trip_ma[RIFFLER_PEN_JOINTS]; /* a larger measured current is a fault; above the peak */
  uint16_t mismatch_ma;                 /* allowed difference of measured and commanded current … */
  uint32_t mismatch_us;                 /* … for longer than this */
  int16_t hottest_dc;                   /* a hotter motor is a fault */
} riffler_pen_config;

/* Measurements for one step. */
typedef struct riffler_pen_sensors {
  int ready;                                  /* all values below are valid; read in the boot state only */
  int stopped;                                /* the emergency stop is open */
  int32_t counters[RIFFLER_PEN_JOINTS];       /* counts, wrap */
  int32_t probe;                              /* counts, wrap */
  int16_t current_ma[RIFFLER_PEN_JOINTS];     /* in the windings */
  int16_t temperature_dc[RIFFLER_PEN_JOINTS]; /* of the windings, or as near as the sensor is */
  uint16_t buttons;
  uint8_t encoder_errors; /* bit k: joint k's encoder or counter had an error since the last step */
  uint8_t driver_faults;  /* bit k: joint k's motor driver reports a fault */
} riffler_pen_sensors;

/* Motor commands. */
typedef struct riffler_pen_drive {
  int16_t current_ma[RIFFLER_PEN_JOINTS]; /* all 0 if power is 0 */
  int power;                              /* drivers on; when off, no current flows, independent of current_ma */
  int brake;                              /* windings shorted; never together with power */
} riffler_pen_drive;

/* The newest output report and its age. */
typedef struct riffler_pen_link {
  riffler_pen_output newest;
  uint32_t age_us;
  uint8_t alive;    /* a report was accepted less than the watchdog's time ago */
  uint8_t taken;    /* a report was accepted since the last step */
  uint8_t disabled; /* one of them disables */
  uint8_t armed;    /* idle, and a disabling report was accepted */
  uint8_t refused_count;
} riffler_pen_link;

typedef struct riffler_pen_firmware {
  riffler_pen_config config;
  uint8_t configured; /* config has no problem */
  riffler_pen_state state;
  riffler_pen_link link;
  uint32_t time_us;
  uint16_t sequence, flags;

  uint8_t fault, fault_joint, fault_count;
  uint32_t quiet_us[RIFFLER_PEN_JOINTS];      /* how long a joint with a large current has not moved */
  uint32_t eased_us;                          /* 0 to RIFFLER_PEN_EASE_US: progress of reducing the force */
  uint32_t mismatched_us[RIFFLER_PEN_JOINTS]; /* how long measured and commanded current have differed */
  riffler_pen_sensors sensors;                /* of the last step */

  riffler_pen_drive drive;              /* of the last step */
  uint32_t ramp_us;                     /* since the ramp began */
  uint32_t rate_rest;                   /* thousandths of a mA carried over from the rate of the last steps */
  int64_t energy[RIFFLER_PEN_JOINTS];   /* mA² µs since heat was last advanced */
  uint32_t energy_us;                   /* duration of that */
  int64_t heat_q12[RIFFLER_PEN_JOINTS]; /* low-pass filtered square of the current: mA² × 4096 */
} riffler_pen_firmware;

/* Time in µs to reduce the force of a motionless joint from full to zero. */
enum { RIFFLER_PEN_EASE_US = 500000 };

/* A fault's cause: RIFFLER_PEN_NO_FAULT, or a fault and its joint (or RIFFLER_PEN_NO_JOINT). */
typedef struct riffler_pen_cause {
  uint8_t fault, joint;
} riffler_pen_cause;

/* What is wrong with a configuration, as text; NULL if nothing is. */
const char* riffler_pen_config_problem(const riffler_pen_config* config);
/* A configuration for a pen with the reference geometry, with limits that are safe to start with; see
 * docs/device.md. */
void riffler_pen_reference_config(riffler_pen_config* config);

/* Starts in the boot state. A configuration with a problem leads to a permanent fault. */
void riffler_pen_init(riffler_pen_firmware* pen, const riffler_pen_config* config);
/* Accepts a report of the host, or refuses it: no valid report, or not newer than the last. Refused reports do
 * not feed the watchdog. */
riffler_pen_result riffler_pen_receive(riffler_pen_firmware* pen, const uint8_t* bytes, size_t size);
/* One step, `elapsed_us` after the one before. Returns the motor commands until the next step. */
riffler_pen_drive riffler_pen_step(riffler_pen_firmware* pen, const riffler_pen_sensors* sensors, uint32_t elapsed_us);
/* The next input report, as of the last step. */
riffler_pen_input riffler_pen_report(riffler_pen_firmware* pen);
/* Writes the feature report with number `id` and returns its size, or 0 if there is none or it does not fit. */
size_t riffler_pen_feature(const riffler_pen_config* config, uint8_t id, uint8_t* bytes, size_t capacity);

/* pen_monitor.c: the cause of a current fault; of several, the one with the lowest number. */
riffler_pen_cause riffler_pen_find_cause(riffler_pen_firmware* pen, const riffler_pen_sensors* sensors,
                                         uint32_t elapsed_us);

/* pen_currents.c: computes the motor commands while the pen pushes, and sets the flags of limits that acted. */
void riffler_pen_push(riffler_pen_firmware* pen, uint32_t elapsed_us);
/* Advances the thermal model of the windings, in every state. */
void riffler_pen_warm(riffler_pen_firmware* pen, uint32_t elapsed_us);
/* Scales all currents by one factor so that none exceeds its limit, which keeps the direction of the force.
 * Returns 1 if it scaled. */
int riffler_pen_limit_currents(int16_t* currents, const uint16_t* limits);
/* Moves `from` straight towards `to`, changing no current by more than `most`. Returns 1 if it did not arrive. */
int riffler_pen_approach(int16_t* from, const int16_t* to, int32_t most);

#ifdef __cplusplus
}
#endif

#endif
