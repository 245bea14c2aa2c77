/* Reference logic of a pen's firmware: what it does with reports and sensors, and what the motors are told.
 *
 * Everything is a function of (state, inputs, elapsed µs): no clock, no interrupt, no allocation, no floating point, so
 * the same code runs in the pen and, on a virtual clock, in the host's tests and simulated pen. pen_board.h ties it to
 * hardware. The order of one step: age of the newest command, causes of a fault, next state, currents.
 *
 * Force needs all of: a report that disabled and then one that enables, reports that keep coming, and no fault. In the
 * step that finds a fault the currents are 0 already. Times are µs, currents mA, temperatures tenths of °C.
 */
#ifndef RIFFLER_DEVICE_FIRMWARE_PEN_FIRMWARE_H
#define RIFFLER_DEVICE_FIRMWARE_PEN_FIRMWARE_H

#include "pen_states.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What the pen is and bears. The limits are told to the host; the rest only the firmware needs. */
typedef struct riffler_pen_config {
  riffler_pen_identity identity;
  riffler_pen_limits limits;
  uint32_t late_us;                     /* a step longer than this, while it pushes, is a fault */
  uint16_t trip_ma[RIFFLER_PEN_JOINTS]; /* measured current that is a fault, above the peak */
  uint16_t mismatch_ma;                 /* by which measured and commanded current may differ … */
  uint32_t mismatch_us;                 /* … for longer than this */
  int16_t hottest_dc;                   /* temperature of a motor that is a fault */
} riffler_pen_config;

/* What the board measures for one step. */
typedef struct riffler_pen_sensors {
  int ready;                                  /* all of the below is valid; asked for in the state of boot only */
  int stopped;                                /* the emergency stop is open */
  int32_t counters[RIFFLER_PEN_JOINTS];       /* counts, wrap */
  int32_t probe;                              /* counts, wrap */
  int16_t current_ma[RIFFLER_PEN_JOINTS];     /* in the windings */
  int16_t temperature_dc[RIFFLER_PEN_JOINTS]; /* of the windings or as near as a sensor gets */
  uint16_t buttons;
  uint8_t encoder_errors; /* bit k: joint k's encoder or its counter has seen an error since the last step */
  uint8_t driver_faults;  /* bit k: joint k's motor driver reports a fault */
} riffler_pen_sensors;

/* What the motors are told. */
typedef struct riffler_pen_drive {
  int16_t current_ma[RIFFLER_PEN_JOINTS]; /* all 0 where power is 0 */
  int power;                              /* drivers on; off, no current whatever current_ma says */
  int brake;                              /* windings shorted: never together with power */
} riffler_pen_drive;

/* The newest output report and how old it is. */
typedef struct riffler_pen_link {
  riffler_pen_output newest;
  uint32_t age_us;
  uint8_t alive;    /* a report was taken, and less than the watchdog's time ago */
  uint8_t taken;    /* one was taken since the last step */
  uint8_t disabled; /* one that disables was among them */
  uint8_t armed;    /* idle, and disabled */
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
  uint32_t quiet_us[RIFFLER_PEN_JOINTS];      /* for how long a joint with much current has not moved */
  uint32_t eased_us;                          /* 0 to RIFFLER_PEN_EASE_US: how far the force is eased, to see it move */
  uint32_t mismatched_us[RIFFLER_PEN_JOINTS]; /* for how long measured and commanded current differ */
  riffler_pen_sensors sensors;                /* of the last step */

  riffler_pen_drive drive;              /* of the last step */
  uint32_t ramp_us;                     /* since the ramp began */
  uint32_t rate_rest;                   /* thousandths of a mA that the last steps' rate left over */
  int64_t energy[RIFFLER_PEN_JOINTS];   /* mA² µs since heat was last brought forward */
  uint32_t energy_us;                   /* how long that is */
  int64_t heat_q12[RIFFLER_PEN_JOINTS]; /* square of the current, through the winding's time constant: mA² × 4096 */
} riffler_pen_firmware;

/* The time in which a joint that stands under force is eased, from all of the force to none. */
enum { RIFFLER_PEN_EASE_US = 500000 };

/* A fault's cause: RIFFLER_PEN_NO_FAULT, or a fault and its joint (or RIFFLER_PEN_NO_JOINT). */
typedef struct riffler_pen_cause {
  uint8_t fault, joint;
} riffler_pen_cause;

/* What is wrong with a configuration, in words; NULL if nothing is. */
const char* riffler_pen_config_problem(const riffler_pen_config* config);
/* A configuration for the pen of the reference geometry, with limits that are safe to begin with; see docs/device.md.
 */
void riffler_pen_reference_config(riffler_pen_config* config);

/* State of boot. A configuration with a problem leads to a fault that is never left. */
void riffler_pen_init(riffler_pen_firmware* pen, const riffler_pen_config* config);
/* Takes what the host sent, or refuses it: not a report, or not newer than the last. Refused reports feed no watchdog.
 */
riffler_pen_result riffler_pen_receive(riffler_pen_firmware* pen, const uint8_t* bytes, size_t size);
/* One step: `elapsed_us` after the one before. The result is what to tell the motors until the next. */
riffler_pen_drive riffler_pen_step(riffler_pen_firmware* pen, const riffler_pen_sensors* sensors, uint32_t elapsed_us);
/* The next input report, as of the last step. */
riffler_pen_input riffler_pen_report(riffler_pen_firmware* pen);
/* The feature report of that number: its size, or 0 if there is none or it does not fit. */
size_t riffler_pen_feature(const riffler_pen_config* config, uint8_t id, uint8_t* bytes, size_t capacity);

/* pen_monitor.c: the cause of a fault that is there, the lowest number of several. */
riffler_pen_cause riffler_pen_find_cause(riffler_pen_firmware* pen, const riffler_pen_sensors* sensors,
                                         uint32_t elapsed_us);

/* pen_currents.c: what the motors are told where the pen pushes; sets the flags that say what was held back. */
void riffler_pen_push(riffler_pen_firmware* pen, uint32_t elapsed_us);
/* Brings the model of the windings' heat forward, in every state. */
void riffler_pen_warm(riffler_pen_firmware* pen, uint32_t elapsed_us);
/* Scales all currents by one factor so that none exceeds its limit: the direction of the force stays. 1 if it did. */
int riffler_pen_limit_currents(int16_t* currents, const uint16_t* limits);
/* Moves `from` straight towards `to`, no current by more than `most`. 1 if it did not get there. */
int riffler_pen_approach(int16_t* from, const int16_t* to, int32_t most);

#ifdef __cplusplus
}
#endif

#endif
