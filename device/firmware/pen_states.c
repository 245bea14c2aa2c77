#include "pen_states.h"

riffler_pen_state riffler_pen_next_state(riffler_pen_state state, unsigned events) {
  if (events & RIFFLER_PEN_ON_FAULT) return RIFFLER_PEN_FAULT;
  switch (state) {
    case RIFFLER_PEN_BOOT:
      return events & RIFFLER_PEN_ON_READY ? RIFFLER_PEN_IDLE : RIFFLER_PEN_BOOT;
    case RIFFLER_PEN_IDLE:
      return events & RIFFLER_PEN_ON_ENABLE ? RIFFLER_PEN_RAMP : RIFFLER_PEN_IDLE;
    case RIFFLER_PEN_RAMP:
      if (events & RIFFLER_PEN_ON_DISABLE) return RIFFLER_PEN_IDLE;
      return events & RIFFLER_PEN_ON_FULL ? RIFFLER_PEN_ACTIVE : RIFFLER_PEN_RAMP;
    case RIFFLER_PEN_ACTIVE:
      return events & RIFFLER_PEN_ON_DISABLE ? RIFFLER_PEN_IDLE : RIFFLER_PEN_ACTIVE;
    case RIFFLER_PEN_FAULT:
      return events & RIFFLER_PEN_ON_DISABLE ? RIFFLER_PEN_IDLE : RIFFLER_PEN_FAULT;
  }
  return RIFFLER_PEN_FAULT;
}

int riffler_pen_pushes(riffler_pen_state state) {
  return state == RIFFLER_PEN_RAMP || state == RIFFLER_PEN_ACTIVE;
}
