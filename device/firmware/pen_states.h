/* The states of a pen's firmware, and the one place that says which follows which. */
#ifndef RIFFLER_DEVICE_FIRMWARE_PEN_STATES_H
#define RIFFLER_DEVICE_FIRMWARE_PEN_STATES_H

#include "../protocol/pen_protocol.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What one step may find, as bits. */
enum {
  RIFFLER_PEN_ON_FAULT = 1 << 0,   /* a cause of a fault is there */
  RIFFLER_PEN_ON_READY = 1 << 1,   /* the board's sensors are valid */
  RIFFLER_PEN_ON_DISABLE = 1 << 2, /* a report that disables was taken since the last step */
  RIFFLER_PEN_ON_ENABLE = 1 << 3,  /* the newest report enables, and the pen is armed: one before it disabled */
  RIFFLER_PEN_ON_FULL = 1 << 4     /* the ramp has reached full force */
};
enum { RIFFLER_PEN_EVENTS = 5 };

/* The state after a step that found `events` in `state`. A fault goes before everything, to disable before the rest. A
 * state that does not exist leads to fault. */
riffler_pen_state riffler_pen_next_state(riffler_pen_state state, unsigned events);

/* Whether motors may have current in this state. */
int riffler_pen_pushes(riffler_pen_state state);

#ifdef __cplusplus
}
#endif

#endif
