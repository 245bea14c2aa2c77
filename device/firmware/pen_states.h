/* The states of a pen's firmware, and the only definition of their transitions. */
#ifndef RIFFLER_DEVICE_FIRMWARE_PEN_STATES_H
#define RIFFLER_DEVICE_FIRMWARE_PEN_STATES_H

#include "../protocol/pen_protocol.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Events of one step, as bits. */
enum {
  RIFFLER_PEN_ON_FAULT = 1 << 0,   /* a cause of a fault exists */
  RIFFLER_PEN_ON_READY = 1 << 1,   /* the board's sensors are valid */
  RIFFLER_PEN_ON_DISABLE = 1 << 2, /* a disabling report was accepted since the last step */
  RIFFLER_PEN_ON_ENABLE = 1 << 3,  /* the newest report enables, and the pen is armed: an earlier one disabled */
  RIFFLER_PEN_ON_FULL = 1 << 4     /* the ramp has reached full force */
};
enum { RIFFLER_PEN_EVENTS = 5 };

/* The state after a step with `events` in `state`. A fault takes precedence over everything, disabling over the
 * rest. An invalid state leads to fault. */
riffler_pen_state riffler_pen_next_state(riffler_pen_state state, unsigned events);

/* Whether motors may carry current in this state. */
int riffler_pen_pushes(riffler_pen_state state);

#ifdef __cplusplus
}
#endif

#endif
