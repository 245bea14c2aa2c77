#include "pen_protocol.h"

static const uint8_t kMagic[4] = {'R', 'P', 'e', 'n'};

/* --- Bytes: least significant first
 * ------------------------------------------------------------------------------- */

static void put16(uint8_t* at, uint16_t value) {
  at[0] = (uint8_t)(value & 0xFFU);
  at[1] = (uint8_t)(value >> 8);
}

static void put32(uint8_t* at, uint32_t value) {
  put16(at, (uint16_t)(value & 0xFFFFU));
  put16(at + 2, (uint16_t)(value >> 16));
}

static uint16_t get16(const uint8_t* at) {
  return (uint16_t)((uint32_t)at[0] | ((uint32_t)at[1] << 8));
}

static uint32_t get32(const uint8_t* at) {
  return (uint32_t)get16(at) | ((uint32_t)get16(at + 2) << 16);
}

/* Two's complement without the implementation-defined conversion of C11 (6.3.1.3). */
static int32_t to_signed32(uint32_t bits) {
  return bits <= (uint32_t)INT32_MAX ? (int32_t)bits : (int32_t)(bits - 0x80000000U) + INT32_MIN;
}

static int16_t to_signed16(uint16_t bits) {
  return (int16_t)(bits <= INT16_MAX ? (int32_t)bits : (int32_t)bits - 65536);
}

static void put_currents(uint8_t* at, const int16_t* currents) {
  for (size_t k = 0; k < RIFFLER_PEN_JOINTS; ++k) put16(at + 2 * k, (uint16_t)currents[k]);
}

static void get_currents(const uint8_t* at, int16_t* currents) {
  for (size_t k = 0; k < RIFFLER_PEN_JOINTS; ++k) currents[k] = to_signed16(get16(at + 2 * k));
}

/* A name starts at the beginning of its field; the rest is 0. */
static void put_name(uint8_t* at, const char* name, size_t chars) {
  size_t k = 0;
  for (; k < chars && name[k] != '\0'; ++k) at[k] = (uint8_t)name[k];
  for (; k < chars; ++k) at[k] = 0;
}

static int get_name(const uint8_t* at, char* name, size_t chars) {
  size_t length = 0;
  while (length < chars && at[length] > 0x20 && at[length] < 0x7F) ++length;
  for (size_t k = 0; k < length; ++k) name[k] = (char)at[k];
  for (size_t k = length; k <= chars; ++k) name[k] = '\0';
  for (size_t k = length; k < chars; ++k)
    if (at[k] != 0) return 0;
  return length > 0;
}

static riffler_pen_result check_frame(const uint8_t* bytes, size_t size, size_t expected, uint8_t id) {
  if (size != expected) return RIFFLER_PEN_WRONG_LENGTH;
  return bytes[0] == id ? RIFFLER_PEN_OK : RIFFLER_PEN_WRONG_ID;
}

/* --- Input -------------------------------------------------------------------------------------------------------- */

void riffler_pen_encode_input(const riffler_pen_input* report, uint8_t* bytes) {
  bytes[0] = RIFFLER_PEN_INPUT_ID;
  bytes[RIFFLER_PEN_INPUT_STATE] = (uint8_t)report->state;
  put16(bytes + RIFFLER_PEN_INPUT_SEQUENCE, report->sequence);
  put32(bytes + RIFFLER_PEN_INPUT_TIME, report->time_us);
  for (size_t k = 0; k < RIFFLER_PEN_JOINTS; ++k)
    put32(bytes + RIFFLER_PEN_INPUT_COUNTERS + 4 * k, (uint32_t)report->counters[k]);
  put32(bytes + RIFFLER_PEN_INPUT_PROBE, (uint32_t)report->probe);
  put16(bytes + RIFFLER_PEN_INPUT_BUTTONS, report->buttons);
  put16(bytes + RIFFLER_PEN_INPUT_FLAGS, report->flags);
  bytes[RIFFLER_PEN_INPUT_FAULT] = report->fault;
  bytes[RIFFLER_PEN_INPUT_FAULT_JOINT] = report->fault_joint;
  bytes[RIFFLER_PEN_INPUT_FAULT_COUNT] = report->fault_count;
  bytes[RIFFLER_PEN_INPUT_REFUSED_COUNT] = report->refused_count;
  put16(bytes + RIFFLER_PEN_INPUT_ECHO_SEQUENCE, report->echo_sequence);
  put_currents(bytes + RIFFLER_PEN_INPUT_APPLIED, report->applied);
  put32(bytes + RIFFLER_PEN_INPUT_ECHO_TIME, report->echo_time_us);
}

/* A fault code is present exactly in the fault state, and only a fault names a joint. */
static int is_consistent(uint8_t state, uint8_t fault, uint8_t joint) {
  if (state >= RIFFLER_PEN_STATES || (state == RIFFLER_PEN_FAULT) != (fault != RIFFLER_PEN_NO_FAULT)) return 0;
  return joint == RIFFLER_PEN_NO_JOINT || (joint < RIFFLER_PEN_JOINTS && fault != RIFFLER_PEN_NO_FAULT);
}

riffler_pen_result riffler_pen_decode_input(const uint8_t* bytes, size_t size, riffler_pen_input* report) {
  const riffler_pen_result frame = check_frame(bytes, size, RIFFLER_PEN_INPUT_SIZE, RIFFLER_PEN_INPUT_ID);
  if (frame != RIFFLER_PEN_OK) return frame;
  if (!is_consistent(bytes[RIFFLER_PEN_INPUT_STATE], bytes[RIFFLER_PEN_INPUT_FAULT],
                     bytes[RIFFLER_PEN_INPUT_FAULT_JOINT]))
    return RIFFLER_PEN_BAD_STATE;
  report->state = (riffler_pen_state)bytes[RIFFLER_PEN_INPUT_STATE];
  report->sequence = get16(bytes + RIFFLER_PEN_INPUT_SEQUENCE);
  report->time_us = get32(bytes + RIFFLER_PEN_INPUT_TIME);
  for (size_t k = 0; k < RIFFLER_PEN_JOINTS; ++k)
    report->counters[k] = to_signed32(get32(bytes + RIFFLER_PEN_INPUT_COUNTERS + 4 * k));
  report->probe = to_signed32(get32(bytes + RIFFLER_PEN_INPUT_PROBE));
  report->buttons = get16(bytes + RIFFLER_PEN_INPUT_BUTTONS);
  report->flags = get16(bytes + RIFFLER_PEN_INPUT_FLAGS);
  report->fault = bytes[RIFFLER_PEN_INPUT_FAULT];
  report->fault_joint = bytes[RIFFLER_PEN_INPUT_FAULT_JOINT];
  report->fault_count = bytes[RIFFLER_PEN_INPUT_FAULT_COUNT];
  report->refused_count = bytes[RIFFLER_PEN_INPUT_REFUSED_COUNT];
  report->echo_sequence = get16(bytes + RIFFLER_PEN_INPUT_ECHO_SEQUENCE);
  get_currents(bytes + RIFFLER_PEN_INPUT_APPLIED, report->applied);
  report->echo_time_us = get32(bytes + RIFFLER_PEN_INPUT_ECHO_TIME);
  return RIFFLER_PEN_OK;
}

/* --- Output ------------------------------------------------------------------------------------------------------- */

void riffler_pen_encode_output(const riffler_pen_output* report, uint8_t* bytes) {
  bytes[0] = RIFFLER_PEN_OUTPUT_ID;
  bytes[RIFFLER_PEN_OUTPUT_FLAGS] = report->enable ? RIFFLER_PEN_OUTPUT_ENABLE : 0;
  put16(bytes + RIFFLER_PEN_OUTPUT_SEQUENCE, report->sequence);
  put32(bytes + RIFFLER_PEN_OUTPUT_TIME, report->time_us);
  put_currents(bytes + RIFFLER_PEN_OUTPUT_COMMANDS, report->commands);
}

riffler_pen_result riffler_pen_decode_output(const uint8_t* bytes, size_t size, riffler_pen_output* report) {
  const riffler_pen_result frame = check_frame(bytes, size, RIFFLER_PEN_OUTPUT_SIZE, RIFFLER_PEN_OUTPUT_ID);
  if (frame != RIFFLER_PEN_OK) return frame;
  if (bytes[RIFFLER_PEN_OUTPUT_FLAGS] > RIFFLER_PEN_OUTPUT_ENABLE) return RIFFLER_PEN_BAD_FLAGS;
  report->enable = bytes[RIFFLER_PEN_OUTPUT_FLAGS];
  report->sequence = get16(bytes + RIFFLER_PEN_OUTPUT_SEQUENCE);
  report->time_us = get32(bytes + RIFFLER_PEN_OUTPUT_TIME);
  get_currents(bytes + RIFFLER_PEN_OUTPUT_COMMANDS, report->commands);
  return RIFFLER_PEN_OK;
}

/* --- Identity ----------------------------------------------------------------------------------------------------- */

void riffler_pen_encode_identity(const riffler_pen_identity* report, uint8_t* bytes) {
  bytes[0] = RIFFLER_PEN_IDENTITY_ID;
  for (size_t k = 0; k < sizeof kMagic; ++k) bytes[RIFFLER_PEN_IDENTITY_MAGIC + k] = kMagic[k];
  bytes[RIFFLER_PEN_IDENTITY_MAJOR] = report->major;
  bytes[RIFFLER_PEN_IDENTITY_MINOR] = report->minor;
  bytes[RIFFLER_PEN_IDENTITY_RESERVED] = 0;
  put16(bytes + RIFFLER_PEN_IDENTITY_FIRMWARE, report->firmware);
  put_name(bytes + RIFFLER_PEN_IDENTITY_GEOMETRY, report->geometry, RIFFLER_PEN_GEOMETRY_CHARS);
  put_name(bytes + RIFFLER_PEN_IDENTITY_SERIAL, report->serial, RIFFLER_PEN_SERIAL_CHARS);
}

riffler_pen_result riffler_pen_decode_identity(const uint8_t* bytes, size_t size, riffler_pen_identity* report) {
  /* Decode these bytes first: another version may have another length. */
  if (size <= RIFFLER_PEN_IDENTITY_MINOR) return RIFFLER_PEN_WRONG_LENGTH;
  if (bytes[0] != RIFFLER_PEN_IDENTITY_ID) return RIFFLER_PEN_WRONG_ID;
  for (size_t k = 0; k < sizeof kMagic; ++k)
    if (bytes[RIFFLER_PEN_IDENTITY_MAGIC + k] != kMagic[k]) return RIFFLER_PEN_NOT_A_PEN;
  riffler_pen_identity read;
  read.major = bytes[RIFFLER_PEN_IDENTITY_MAJOR];
  read.minor = bytes[RIFFLER_PEN_IDENTITY_MINOR];
  if (read.major != RIFFLER_PEN_PROTOCOL_MAJOR) {
    report->major = read.major;
    report->minor = read.minor;
    return RIFFLER_PEN_OTHER_VERSION;
  }
  if (size != RIFFLER_PEN_IDENTITY_SIZE) return RIFFLER_PEN_WRONG_LENGTH;
  if (bytes[RIFFLER_PEN_IDENTITY_RESERVED] != 0) return RIFFLER_PEN_BAD_RESERVED;
  read.firmware = get16(bytes + RIFFLER_PEN_IDENTITY_FIRMWARE);
  if (!get_name(bytes + RIFFLER_PEN_IDENTITY_GEOMETRY, read.geometry, RIFFLER_PEN_GEOMETRY_CHARS) ||
      !get_name(bytes + RIFFLER_PEN_IDENTITY_SERIAL, read.serial, RIFFLER_PEN_SERIAL_CHARS))
    return RIFFLER_PEN_BAD_NAME;
  *report = read;
  return RIFFLER_PEN_OK;
}

/* --- Limits ------------------------------------------------------------------------------------------------------- */

void riffler_pen_encode_limits(const riffler_pen_limits* report, uint8_t* bytes) {
  bytes[0] = RIFFLER_PEN_LIMITS_ID;
  bytes[RIFFLER_PEN_LIMITS_RESERVED] = 0;
  for (size_t k = 0; k < RIFFLER_PEN_JOINTS; ++k) {
    put16(bytes + RIFFLER_PEN_LIMITS_PEAK + 2 * k, report->peak_ma[k]);
    put16(bytes + RIFFLER_PEN_LIMITS_CONTINUOUS + 2 * k, report->continuous_ma[k]);
  }
  put16(bytes + RIFFLER_PEN_LIMITS_RATE, report->rate_ma_per_ms);
  put16(bytes + RIFFLER_PEN_LIMITS_THERMAL, report->thermal_ms);
  put32(bytes + RIFFLER_PEN_LIMITS_PERIOD, report->period_us);
  put32(bytes + RIFFLER_PEN_LIMITS_STALE, report->stale_us);
  put32(bytes + RIFFLER_PEN_LIMITS_WATCHDOG, report->watchdog_us);
  put32(bytes + RIFFLER_PEN_LIMITS_RAMP, report->ramp_us);
  put32(bytes + RIFFLER_PEN_LIMITS_SPEED, report->speed_counts_per_s);
  put16(bytes + RIFFLER_PEN_LIMITS_STALL_CURRENT, report->stall_ma);
  put16(bytes + RIFFLER_PEN_LIMITS_STALL_TIME, report->stall_ms);
}

riffler_pen_result riffler_pen_decode_limits(const uint8_t* bytes, size_t size, riffler_pen_limits* report) {
  const riffler_pen_result frame = check_frame(bytes, size, RIFFLER_PEN_LIMITS_SIZE, RIFFLER_PEN_LIMITS_ID);
  if (frame != RIFFLER_PEN_OK) return frame;
  if (bytes[RIFFLER_PEN_LIMITS_RESERVED] != 0) return RIFFLER_PEN_BAD_RESERVED;
  riffler_pen_limits read;
  for (size_t k = 0; k < RIFFLER_PEN_JOINTS; ++k) {
    read.peak_ma[k] = get16(bytes + RIFFLER_PEN_LIMITS_PEAK + 2 * k);
    read.continuous_ma[k] = get16(bytes + RIFFLER_PEN_LIMITS_CONTINUOUS + 2 * k);
  }
  read.rate_ma_per_ms = get16(bytes + RIFFLER_PEN_LIMITS_RATE);
  read.thermal_ms = get16(bytes + RIFFLER_PEN_LIMITS_THERMAL);
  read.period_us = get32(bytes + RIFFLER_PEN_LIMITS_PERIOD);
  read.stale_us = get32(bytes + RIFFLER_PEN_LIMITS_STALE);
  read.watchdog_us = get32(bytes + RIFFLER_PEN_LIMITS_WATCHDOG);
  read.ramp_us = get32(bytes + RIFFLER_PEN_LIMITS_RAMP);
  read.speed_counts_per_s = get32(bytes + RIFFLER_PEN_LIMITS_SPEED);
  read.stall_ma = get16(bytes + RIFFLER_PEN_LIMITS_STALL_CURRENT);
  read.stall_ms = get16(bytes + RIFFLER_PEN_LIMITS_STALL_TIME);
  if (riffler_pen_limits_problem(&read) != NULL) return RIFFLER_PEN_BAD_LIMITS;
  *report = read;
  return RIFFLER_PEN_OK;
}

const char* riffler_pen_limits_problem(const riffler_pen_limits* limits) {
  for (size_t k = 0; k < RIFFLER_PEN_JOINTS; ++k) {
    if (limits->peak_ma[k] == 0 || limits->peak_ma[k] > INT16_MAX) return "a peak current is not within 1 … 32767 mA";
    if (limits->continuous_ma[k] == 0 || limits->continuous_ma[k] > limits->peak_ma[k])
      return "a continuous current is 0 or above its peak";
  }
  if (limits->rate_ma_per_ms == 0) return "the current's rate limit is 0";
  if (limits->thermal_ms == 0) return "the thermal time constant is 0";
  if (limits->period_us < 125 || limits->period_us > 100000) return "the report period is not within 125 … 100000 µs";
  if (limits->watchdog_us > 1000000) return "the watchdog's time is above 1 s";
  if (limits->watchdog_us <= limits->period_us) return "the watchdog's time is not above the report period";
  if (limits->stale_us < limits->period_us) return "commands go stale sooner than reports can come";
  if (limits->stale_us >= limits->watchdog_us) return "commands do not go stale before the watchdog's time";
  if (limits->ramp_us == 0 || limits->ramp_us > 60000000) return "the enable ramp is not within 1 µs … 60 s";
  if (limits->speed_counts_per_s == 0 || limits->speed_counts_per_s > 100000000)
    return "the fastest speed of a joint is not within 1 … 10⁸ counts/s";
  if (limits->stall_ma == 0 || limits->stall_ms == 0) return "the stall's current or time is 0";
  for (size_t k = 0; k < RIFFLER_PEN_JOINTS; ++k)
    if (limits->stall_ma > limits->continuous_ma[k])
      return "the stall's current is above a continuous current: a warm motor would never show a stall";
  return NULL;
}

/* --- Words and numbers -------------------------------------------------------------------------------------------- */

const char* riffler_pen_state_text(unsigned state) {
  static const char* const kTexts[RIFFLER_PEN_STATES] = {"boot", "idle", "ramp", "active", "fault"};
  return state < RIFFLER_PEN_STATES ? kTexts[state] : "unknown state";
}

const char* riffler_pen_fault_text(unsigned fault) {
  static const char* const kTexts[RIFFLER_PEN_FAULTS] = {
      "no fault",     "configuration",  "internal",           "emergency stop",   "driver",
      "over-current", "drive mismatch", "temperature sensor", "over-temperature", "encoder signal",
      "encoder jump", "stall",          "late step",          "watchdog"};
  return fault < RIFFLER_PEN_FAULTS ? kTexts[fault] : "unknown fault";
}

const char* riffler_pen_result_text(unsigned result) {
  static const char* const kTexts[RIFFLER_PEN_RESULTS] = {"a valid report",
                                                          "not the report's length",
                                                          "another report's number",
                                                          "not a Riffler pen",
                                                          "another major version of the protocol",
                                                          "a state that does not exist or does not fit the fault",
                                                          "a flag that has no meaning",
                                                          "a reserved byte that is not 0",
                                                          "a name that is empty or not graphic ASCII",
                                                          "limits out of their ranges",
                                                          "not newer than the report before"};
  return result < RIFFLER_PEN_RESULTS ? kTexts[result] : "unknown result";
}

int riffler_pen_is_newer(uint16_t a, uint16_t b) {
  const uint16_t ahead = (uint16_t)(((uint32_t)a - (uint32_t)b) & 0xFFFFU);
  return ahead != 0 && ahead <= 0x7FFF;
}

int32_t riffler_pen_counts_between(int32_t a, int32_t b) {
  return to_signed32((uint32_t)a - (uint32_t)b);
}
