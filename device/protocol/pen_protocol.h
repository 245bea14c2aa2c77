/* The reports that a Riffler pen and its host exchange over USB HID: layout, bounds, codec.
 *
 * One header for both ends: the host's driver and the firmware compile the same file, as C11 or as C++. Nothing
 * here allocates, keeps state or casts structs to bytes: every field is written and read byte by byte,
 * little-endian, at the offset given below. docs/device.md has the same tables in prose; a test compares the two.
 *
 * Reports have no checksum. A full-speed interrupt or control transfer has a CRC-16 in each data packet and is
 * repeated on failure (USB 2.0, 8.3.5 and 8.6), hidraw delivers only complete reports, and every report fits in
 * one packet. A pen behind another connection (a serial line in between) must protect that connection itself.
 *
 * Versions: the first seven bytes of the identity report are the same in every version. With another major
 * version, nothing else can be relied on: host and pen then exchange no force. A minor version may add flags,
 * faults and meanings of reserved bytes, but never moves a field; decoders therefore keep flags and faults that
 * they do not know. */
#ifndef RIFFLER_DEVICE_PROTOCOL_PEN_PROTOCOL_H
#define RIFFLER_DEVICE_PROTOCOL_PEN_PROTOCOL_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Number of pid.codes for private tests: every project may use it on its own bench, but no device with it may be
 * sold or given away (https://pid.codes/1209/0001/). It therefore identifies nothing: use the product name and
 * the identity report. */
#define RIFFLER_PEN_VENDOR_ID 0x1209
#define RIFFLER_PEN_PRODUCT_ID 0x0001
/* The USB product string. */
#define RIFFLER_PEN_PRODUCT "Riffler pen"
/* Usage of the collection in the report descriptor: a vendor page, 'R', and 'P'. */
#define RIFFLER_PEN_USAGE_PAGE 0xFF52
#define RIFFLER_PEN_USAGE 0x0050

#define RIFFLER_PEN_PROTOCOL_MAJOR 1
#define RIFFLER_PEN_PROTOCOL_MINOR 0

enum {
  RIFFLER_PEN_JOINTS = 6, /* θ2 θ3 θ1 of the right arm, then of the left: the order of counters and motors */
  RIFFLER_PEN_GEOMETRY_CHARS = 24,
  RIFFLER_PEN_SERIAL_CHARS = 16,
  RIFFLER_PEN_NO_JOINT = 0xFF /* for a fault that concerns no joint */
};

/* First byte of every report. */
enum { RIFFLER_PEN_INPUT_ID = 1, RIFFLER_PEN_OUTPUT_ID = 2, RIFFLER_PEN_IDENTITY_ID = 3, RIFFLER_PEN_LIMITS_ID = 4 };

/* Size of every report in bytes, including the first: what hidraw reads and writes. All fit in one full-speed
 * packet. */
enum {
  RIFFLER_PEN_INPUT_SIZE = 62,
  RIFFLER_PEN_OUTPUT_SIZE = 20,
  RIFFLER_PEN_IDENTITY_SIZE = 50,
  RIFFLER_PEN_LIMITS_SIZE = 54,
  RIFFLER_PEN_PACKET_SIZE = 64
};

/* Offsets of the fields from the first byte of the report. */
enum {
  RIFFLER_PEN_INPUT_STATE = 1,
  RIFFLER_PEN_INPUT_SEQUENCE = 2,
  RIFFLER_PEN_INPUT_TIME = 4,
  RIFFLER_PEN_INPUT_COUNTERS = 8,
  RIFFLER_PEN_INPUT_PROBE = 32,
  RIFFLER_PEN_INPUT_BUTTONS = 36,
  RIFFLER_PEN_INPUT_FLAGS = 38,
  RIFFLER_PEN_INPUT_FAULT = 40,
  RIFFLER_PEN_INPUT_FAULT_JOINT = 41,
  RIFFLER_PEN_INPUT_FAULT_COUNT = 42,
  RIFFLER_PEN_INPUT_REFUSED_COUNT = 43,
  RIFFLER_PEN_INPUT_ECHO_SEQUENCE = 44,
  RIFFLER_PEN_INPUT_APPLIED = 46,
  RIFFLER_PEN_INPUT_ECHO_TIME = 58,

  RIFFLER_PEN_OUTPUT_FLAGS = 1,
  RIFFLER_PEN_OUTPUT_SEQUENCE = 2,
  RIFFLER_PEN_OUTPUT_TIME = 4,
  RIFFLER_PEN_OUTPUT_COMMANDS = 8,

  RIFFLER_PEN_IDENTITY_MAGIC = 1,
  RIFFLER_PEN_IDENTITY_MAJOR = 5,
  RIFFLER_PEN_IDENTITY_MINOR = 6,
  RIFFLER_PEN_IDENTITY_RESERVED = 7,
  RIFFLER_PEN_IDENTITY_FIRMWARE = 8,
  RIFFLER_PEN_IDENTITY_GEOMETRY = 10,
  RIFFLER_PEN_IDENTITY_SERIAL = 34,

  RIFFLER_PEN_LIMITS_RESERVED = 1,
  RIFFLER_PEN_LIMITS_PEAK = 2,
  RIFFLER_PEN_LIMITS_CONTINUOUS = 14,
  RIFFLER_PEN_LIMITS_RATE = 26,
  RIFFLER_PEN_LIMITS_THERMAL = 28,
  RIFFLER_PEN_LIMITS_PERIOD = 30,
  RIFFLER_PEN_LIMITS_STALE = 34,
  RIFFLER_PEN_LIMITS_WATCHDOG = 38,
  RIFFLER_PEN_LIMITS_RAMP = 42,
  RIFFLER_PEN_LIMITS_SPEED = 46,
  RIFFLER_PEN_LIMITS_STALL_CURRENT = 50,
  RIFFLER_PEN_LIMITS_STALL_TIME = 52
};

/* States of the pen's firmware; device/firmware/pen_states.h has the transitions. */
typedef enum riffler_pen_state {
  RIFFLER_PEN_BOOT = 0,   /* not ready: no force */
  RIFFLER_PEN_IDLE = 1,   /* ready, motors free: no force */
  RIFFLER_PEN_RAMP = 2,   /* force grows from zero to the host's command */
  RIFFLER_PEN_ACTIVE = 3, /* force as commanded by the host, within the limits */
  RIFFLER_PEN_FAULT = 4   /* no force, braked; left by a disabling report once the cause is gone */
} riffler_pen_state;
enum { RIFFLER_PEN_STATES = 5 };

/* Cause of the fault state; of several causes in one step, the lowest number. */
typedef enum riffler_pen_fault {
  RIFFLER_PEN_NO_FAULT = 0,
  RIFFLER_PEN_CONFIGURATION = 1,      /* the firmware's own limits are invalid: cleared only by a restart */
  RIFFLER_PEN_INTERNAL = 2,           /* an invalid state, so memory is damaged: cleared only by a restart */
  RIFFLER_PEN_EMERGENCY_STOP = 3,     /* the stop input is open */
  RIFFLER_PEN_DRIVER = 4,             /* a motor driver reports a fault */
  RIFFLER_PEN_OVER_CURRENT = 5,       /* measured current of a motor too high */
  RIFFLER_PEN_DRIVE_MISMATCH = 6,     /* measured and commanded current differ for too long */
  RIFFLER_PEN_TEMPERATURE_SENSOR = 7, /* open or shorted */
  RIFFLER_PEN_OVER_TEMPERATURE = 8,   /* cleared when 10 °C cooler */
  RIFFLER_PEN_ENCODER_SIGNAL = 9,     /* the encoder's own error line, or both phases changed at once */
  RIFFLER_PEN_ENCODER_JUMP = 10,      /* more counts than the arm can move in that time */
  RIFFLER_PEN_STALL = 11,     /* no count under force, nor while it was reduced to zero: a dead encoder or a stop */
  RIFFLER_PEN_LATE_STEP = 12, /* the firmware's own loop was late while pushing */
  RIFFLER_PEN_WATCHDOG = 13   /* no new output report within the watchdog's time while pushing */
} riffler_pen_fault;
enum { RIFFLER_PEN_FAULTS = 14 };

/* Flags of an input report. */
enum {
  RIFFLER_PEN_FLAG_HOST = 1 << 0,         /* output reports arrive within the watchdog's time */
  RIFFLER_PEN_FLAG_ARMED = 1 << 1,        /* idle, and the next enabling report starts the ramp */
  RIFFLER_PEN_FLAG_STALE = 1 << 2,        /* the newest command is old: force decays */
  RIFFLER_PEN_FLAG_LIMITED = 1 << 3,      /* all commands were scaled down to the limits */
  RIFFLER_PEN_FLAG_FOLDBACK = 1 << 4,     /* a motor is warm: its limit is below its peak */
  RIFFLER_PEN_FLAG_RATE_LIMITED = 1 << 5, /* currents have not reached the command yet */
  RIFFLER_PEN_FLAG_BRAKE = 1 << 6         /* the windings are shorted */
};

/* Flags of an output report. A report with any other bit is refused: the pen must not guess. */
enum { RIFFLER_PEN_OUTPUT_ENABLE = 1 << 0 };

/* Pen → host, once per report period. */
typedef struct riffler_pen_input {
  riffler_pen_state state;
  uint16_t sequence;                    /* number of this report; wraps */
  uint32_t time_us;                     /* time at which the counters were read, on the pen's clock; wraps after
                                         * 71.6 min */
  int32_t counters[RIFFLER_PEN_JOINTS]; /* counts since power-on, quadrature × 4; wrap */
  int32_t probe;                        /* counts of the probe's rotation about itself; wrap */
  uint16_t buttons;                     /* bit 0 is button 1 */
  uint16_t flags;                       /* RIFFLER_PEN_FLAG_… */
  uint8_t fault;                        /* riffler_pen_fault, possibly of a later minor version; 0 in other states */
  uint8_t fault_joint;                  /* joint of the fault, or RIFFLER_PEN_NO_JOINT */
  uint8_t fault_count;                  /* faults since power-on, wraps: reveals faults between two reports */
  uint8_t refused_count;                /* refused output reports, wraps */
  uint16_t echo_sequence;               /* number of the newest accepted output report */
  int16_t applied[RIFFLER_PEN_JOINTS];  /* mA commanded to the motors in the last step */
  uint32_t echo_time_us;                /* host time of the newest accepted output report */
} riffler_pen_input;

/* Host → pen. */
typedef struct riffler_pen_output {
  int enable;                           /* 0 or 1 */
  uint16_t sequence;                    /* newer than the last, by riffler_pen_is_newer; wraps */
  uint32_t time_us;                     /* on the host's clock; the pen only echoes it */
  int16_t commands[RIFFLER_PEN_JOINTS]; /* mA; positive turns the motor so that its counter grows */
} riffler_pen_output;

/* Identity of the pen. Feature report, read-only for the host. */
typedef struct riffler_pen_identity {
  uint8_t major, minor;                          /* of the protocol */
  uint16_t firmware;                             /* version of the firmware, assigned by its maker */
  char geometry[RIFFLER_PEN_GEOMETRY_CHARS + 1]; /* name of the file in device/geometry, without its suffix */
  char serial[RIFFLER_PEN_SERIAL_CHARS + 1];
} riffler_pen_identity;

/* Limits of the pen. Feature report, read-only for the host, so that no host can raise a limit. */
typedef struct riffler_pen_limits {
  uint16_t peak_ma[RIFFLER_PEN_JOINTS];       /* 1 … 32767 */
  uint16_t continuous_ma[RIFFLER_PEN_JOINTS]; /* 1 … peak; the limit falls to it as the motor warms up */
  uint16_t rate_ma_per_ms;                    /* largest change of any current, except to zero on a fault; > 0 */
  uint16_t thermal_ms;                        /* time constant of the windings, 1 … 65535 */
  uint32_t period_us;                         /* between input reports, 125 … 100 000 */
  uint32_t stale_us;                          /* age from which a command decays, reaching zero at the watchdog's
                                               * time */
  uint32_t watchdog_us;                       /* age of a command at which the pen goes to fault, ≤ 1 000 000 */
  uint32_t ramp_us;                           /* from zero to full force, ≤ 60 000 000 */
  uint32_t speed_counts_per_s;                /* largest speed of a joint; faster is a jump, 1 … 100 000 000 */
  uint16_t stall_ma; /* a joint with this current and no count may be stalled, 1 … every continuous current */
  uint16_t stall_ms; /* … after this time, > 0; then the force is reduced */
} riffler_pen_limits;

typedef enum riffler_pen_result {
  RIFFLER_PEN_OK = 0,
  RIFFLER_PEN_WRONG_LENGTH,  /* another length than the report's */
  RIFFLER_PEN_WRONG_ID,      /* another report's number */
  RIFFLER_PEN_NOT_A_PEN,     /* wrong magic bytes in the identity */
  RIFFLER_PEN_OTHER_VERSION, /* another major version of the protocol */
  RIFFLER_PEN_BAD_STATE,     /* an invalid state, or one that contradicts the fault */
  RIFFLER_PEN_BAD_FLAGS,     /* an undefined bit */
  RIFFLER_PEN_BAD_RESERVED,  /* a reserved byte is not 0 */
  RIFFLER_PEN_BAD_NAME,      /* geometry or serial: empty, not graphic ASCII, or bytes after its end */
  RIFFLER_PEN_BAD_LIMITS,    /* riffler_pen_limits_problem gives the reason */
  RIFFLER_PEN_OLD_SEQUENCE   /* not newer than the report before: from the receiver, not the codec */
} riffler_pen_result;
enum { RIFFLER_PEN_RESULTS = 11 };

/* Each encodes the whole report, RIFFLER_PEN_…_SIZE bytes. A struct within its bounds decodes to itself. */
void riffler_pen_encode_input(const riffler_pen_input* report, uint8_t* bytes);
void riffler_pen_encode_output(const riffler_pen_output* report, uint8_t* bytes);
void riffler_pen_encode_identity(const riffler_pen_identity* report, uint8_t* bytes);
void riffler_pen_encode_limits(const riffler_pen_limits* report, uint8_t* bytes);

/* Each decodes `size` bytes and reads nothing beyond. `report` is written only if the result is RIFFLER_PEN_OK;
 * except that riffler_pen_decode_identity also sets major and minor with RIFFLER_PEN_OTHER_VERSION, so that a
 * host can report them. */
riffler_pen_result riffler_pen_decode_input(const uint8_t* bytes, size_t size, riffler_pen_input* report);
riffler_pen_result riffler_pen_decode_output(const uint8_t* bytes, size_t size, riffler_pen_output* report);
riffler_pen_result riffler_pen_decode_identity(const uint8_t* bytes, size_t size, riffler_pen_identity* report);
riffler_pen_result riffler_pen_decode_limits(const uint8_t* bytes, size_t size, riffler_pen_limits* report);

/* What is wrong with the limits, as text; NULL if nothing is. */
const char* riffler_pen_limits_problem(const riffler_pen_limits* limits);

/* Lower-case texts for users; "unknown …" for numbers that this version does not know. */
const char* riffler_pen_state_text(unsigned state);
const char* riffler_pen_fault_text(unsigned fault);
const char* riffler_pen_result_text(unsigned result);

/* Whether sequence number `a` comes after `b`, by at most half the range (serial number arithmetic, RFC 1982). */
int riffler_pen_is_newer(uint16_t a, uint16_t b);
/* a − b for counters that wrap. */
int32_t riffler_pen_counts_between(int32_t a, int32_t b);

/* The HID report descriptor. */
extern const uint8_t riffler_pen_descriptor[];
extern const size_t riffler_pen_descriptor_size;

#ifdef __cplusplus
}
#endif

#endif
