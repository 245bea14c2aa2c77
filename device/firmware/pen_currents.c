/* From the host's command to motor currents: limits, ramp, age, rate. Integers throughout; each product states
 * why it fits. */
#include "pen_firmware.h"

/* Fraction bits of heat_q12. */
enum { HEAT_BITS = 12 };
/* Shortest span by which heat is advanced at once, or rounding would lose what short steps add; and the longest,
 * a second. */
static const uint32_t kHeatStepUs = 1000, kHeatLongestUs = 1000000;

static int32_t magnitude(int32_t value) {
  return value < 0 ? -value : value;
}

int riffler_pen_limit_currents(int16_t* currents, const uint16_t* limits) {
  /* The current that exceeds its limit by the largest factor; compared crosswise, 2¹⁵ × 2¹⁶ < 2⁶³. */
  size_t worst = 0;
  for (size_t k = 1; k < RIFFLER_PEN_JOINTS; ++k)
    if ((int64_t)magnitude(currents[k]) * limits[worst] > (int64_t)magnitude(currents[worst]) * limits[k]) worst = k;
  const int32_t limit = limits[worst], asked = magnitude(currents[worst]);
  if (asked <= limit) return 0;
  /* Rounds towards zero, so that no other current exceeds its own limit. */
  for (size_t k = 0; k < RIFFLER_PEN_JOINTS; ++k) currents[k] = (int16_t)((int64_t)currents[k] * limit / asked);
  return 1;
}

int riffler_pen_approach(int16_t* from, const int16_t* to, int32_t most) {
  int32_t farthest = 0;
  for (size_t k = 0; k < RIFFLER_PEN_JOINTS; ++k) {
    const int32_t way = magnitude(to[k] - from[k]);
    if (way > farthest) farthest = way;
  }
  const int stays_behind = farthest > most;
  for (size_t k = 0; k < RIFFLER_PEN_JOINTS; ++k) {
    const int32_t way = to[k] - from[k];
    /* Lies between the two ends, so it fits 16 bits again. */
    from[k] = (int16_t)(from[k] + (stays_behind ? (int32_t)((int64_t)way * most / farthest) : way));
  }
  return stays_behind;
}

/* First-order thermal model of the windings: their heat follows the square of the current with the configured
 * time constant. */
void riffler_pen_warm(riffler_pen_firmware* pen, uint32_t elapsed_us) {
  const uint32_t span = elapsed_us < kHeatLongestUs ? elapsed_us : kHeatLongestUs;
  pen->energy_us += span;
  for (size_t k = 0; k < RIFFLER_PEN_JOINTS; ++k) {
    /* Current since the last step: the larger of the measured and the commanded one. 2³⁰ × 2²¹. */
    const int32_t measured = magnitude(pen->sensors.current_ma[k]), told = magnitude(pen->drive.current_ma[k]);
    const int64_t current = measured > told ? measured : told;
    pen->energy[k] += current * current * span;
  }
  if (pen->energy_us < kHeatStepUs) return;
  const int64_t constant = 1000 * (int64_t)pen->config.limits.thermal_ms;
  const int64_t lasted = pen->energy_us < constant ? pen->energy_us : constant;
  for (size_t k = 0; k < RIFFLER_PEN_JOINTS; ++k) {
    const int64_t mean = pen->energy[k] / pen->energy_us * (1 << HEAT_BITS);
    pen->heat_q12[k] += constant == 0 ? 0 : (mean - pen->heat_q12[k]) * lasted / constant; /* 2⁴² × 2²⁰ */
    pen->energy[k] = 0;
  }
  pen->energy_us = 0;
}

/* Limits per motor: the peak while a winding is below half the heat of the continuous current, then falling
 * linearly to the continuous current, where heat and current reach equilibrium. Returns 1 if any limit is below
 * its peak. */
static int fold_back(const riffler_pen_firmware* pen, uint16_t* limits) {
  int folds = 0;
  for (size_t k = 0; k < RIFFLER_PEN_JOINTS; ++k) {
    const int64_t peak = pen->config.limits.peak_ma[k], lasting = pen->config.limits.continuous_ma[k];
    const int64_t full = lasting * lasting * (1 << HEAT_BITS), half = full / 2, heat = pen->heat_q12[k];
    int64_t limit = peak;
    if (heat >= full)
      limit = lasting;
    else if (heat > half)
      limit = lasting + (peak - lasting) * (full - heat) / (full - half); /* 2¹⁵ × 2⁴² */
    limits[k] = (uint16_t)limit;
    folds |= limit < peak;
  }
  return folds;
}

static void scale(int16_t* currents, uint32_t part, uint32_t whole) {
  for (size_t k = 0; k < RIFFLER_PEN_JOINTS; ++k) currents[k] = (int16_t)((int64_t)currents[k] * part / whole);
}

void riffler_pen_push(riffler_pen_firmware* pen, uint32_t elapsed_us) {
  const riffler_pen_limits* const bounds = &pen->config.limits;
  int16_t wanted[RIFFLER_PEN_JOINTS];
  uint16_t limits[RIFFLER_PEN_JOINTS];
  for (size_t k = 0; k < RIFFLER_PEN_JOINTS; ++k) wanted[k] = pen->link.newest.commands[k];

  /* Limits come first: a ramp on a command far above them would have no effect. */
  if (fold_back(pen, limits)) pen->flags |= RIFFLER_PEN_FLAG_FOLDBACK;
  if (riffler_pen_limit_currents(wanted, limits)) pen->flags |= RIFFLER_PEN_FLAG_LIMITED;
  if (pen->state == RIFFLER_PEN_RAMP) scale(wanted, pen->ramp_us, bounds->ramp_us);
  if (pen->eased_us > 0) {
    pen->flags |= RIFFLER_PEN_FLAG_LIMITED;
    scale(wanted, RIFFLER_PEN_EASE_US - pen->eased_us, RIFFLER_PEN_EASE_US);
  }
  if (pen->link.age_us > bounds->stale_us) {
    pen->flags |= RIFFLER_PEN_FLAG_STALE;
    scale(wanted, bounds->watchdog_us - pen->link.age_us, bounds->watchdog_us - bounds->stale_us);
  }

  /* The remainder of the division carries over to the next step; otherwise short steps would never change
   * anything. */
  const uint64_t rate = (uint64_t)bounds->rate_ma_per_ms * elapsed_us + pen->rate_rest;
  pen->rate_rest = (uint32_t)(rate % 1000);
  const int32_t most = rate / 1000 < UINT16_MAX ? (int32_t)(rate / 1000) : UINT16_MAX;
  if (riffler_pen_approach(pen->drive.current_ma, wanted, most)) pen->flags |= RIFFLER_PEN_FLAG_RATE_LIMITED;
}
