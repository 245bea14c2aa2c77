/* The HID report descriptor (Device Class Definition for HID 1.11, 6.2.2). It describes every field of the codec,
 * so that any HID tool can display a pen's values. Everything is in one vendor collection, so that no system
 * takes the pen for a mouse.
 *
 * Two properties of report parsers shape it. Some read every maximum as signed: a 16-bit maximum of 65535
 * therefore takes four bytes, and 32 unsigned bits, whose maximum would read as −1, are described as four bytes.
 * And a range stays in force until it is set again, so each kind of field sets size, minimum and maximum. */
#include "pen_protocol.h"

#define LOW(x) ((x) & 0xFF)
#define HIGH(x) (((x) >> 8) & 0xFF)

#define USAGE(n) 0x09, (n)
#define REPORT(n) 0x85, (n)
#define COUNT(n) 0x95, (n)
/* Size, minimum, maximum. */
#define BYTES 0x75, 8, 0x15, 0x00, 0x26, 0xFF, 0x00
#define UNSIGNED16 0x75, 16, 0x15, 0x00, 0x27, 0xFF, 0xFF, 0x00, 0x00
#define SIGNED16 0x75, 16, 0x16, 0x00, 0x80, 0x26, 0xFF, 0x7F
#define SIGNED32 0x75, 32, 0x17, 0x00, 0x00, 0x00, 0x80, 0x27, 0xFF, 0xFF, 0xFF, 0x7F
/* Data, variable, absolute; constant for reserved fields. */
#define INPUT 0x81, 0x02
#define OUTPUT 0x91, 0x02
#define FEATURE 0xB1, 0x02
#define RESERVED_FEATURE 0xB1, 0x03

/* clang-format off */
const uint8_t riffler_pen_descriptor[] = {
    0x06, LOW(RIFFLER_PEN_USAGE_PAGE), HIGH(RIFFLER_PEN_USAGE_PAGE),
    USAGE(RIFFLER_PEN_USAGE),
    0xA1, 0x01,  /* collection: application */

    REPORT(RIFFLER_PEN_INPUT_ID),
    BYTES,      COUNT(1), USAGE(0x10), INPUT,  /* state */
    UNSIGNED16, COUNT(1), USAGE(0x11), INPUT,  /* sequence */
    BYTES,      COUNT(4), USAGE(0x12), INPUT,  /* time */
    SIGNED32,   COUNT(6), USAGE(0x13), INPUT,  /* counters */
                COUNT(1), USAGE(0x14), INPUT,  /* probe */
    UNSIGNED16, COUNT(1), USAGE(0x15), INPUT,  /* buttons */
                COUNT(1), USAGE(0x16), INPUT,  /* flags */
    BYTES,      COUNT(1), USAGE(0x17), INPUT,  /* fault */
                COUNT(1), USAGE(0x18), INPUT,  /* joint of the fault */
                COUNT(1), USAGE(0x19), INPUT,  /* faults */
                COUNT(1), USAGE(0x1A), INPUT,  /* refused reports */
    UNSIGNED16, COUNT(1), USAGE(0x1B), INPUT,  /* echo of the sequence */
    SIGNED16,   COUNT(6), USAGE(0x1C), INPUT,  /* applied currents */
    BYTES,      COUNT(4), USAGE(0x1D), INPUT,  /* echo of the host's time */

    REPORT(RIFFLER_PEN_OUTPUT_ID),
    BYTES,      COUNT(1), USAGE(0x20), OUTPUT,  /* flags */
    UNSIGNED16, COUNT(1), USAGE(0x21), OUTPUT,  /* sequence */
    BYTES,      COUNT(4), USAGE(0x22), OUTPUT,  /* time */
    SIGNED16,   COUNT(6), USAGE(0x23), OUTPUT,  /* commanded currents */

    REPORT(RIFFLER_PEN_IDENTITY_ID),
    BYTES,      COUNT(4), USAGE(0x30), FEATURE,  /* magic */
                COUNT(1), USAGE(0x31), FEATURE,  /* major */
                COUNT(1), USAGE(0x32), FEATURE,  /* minor */
                COUNT(1), RESERVED_FEATURE,
    UNSIGNED16, COUNT(1), USAGE(0x33), FEATURE,  /* firmware */
    BYTES,      COUNT(24), USAGE(0x34), FEATURE,  /* geometry */
                COUNT(16), USAGE(0x35), FEATURE,  /* serial */

    REPORT(RIFFLER_PEN_LIMITS_ID),
    BYTES,      COUNT(1), RESERVED_FEATURE,
    UNSIGNED16, COUNT(6), USAGE(0x40), FEATURE,  /* peak currents */
                COUNT(6), USAGE(0x41), FEATURE,  /* continuous currents */
                COUNT(1), USAGE(0x42), FEATURE,  /* rate */
                COUNT(1), USAGE(0x43), FEATURE,  /* thermal time constant */
    BYTES,      COUNT(4), USAGE(0x44), FEATURE,  /* report period */
                COUNT(4), USAGE(0x45), FEATURE,  /* stale time */
                COUNT(4), USAGE(0x46), FEATURE,  /* watchdog */
                COUNT(4), USAGE(0x47), FEATURE,  /* ramp */
                COUNT(4), USAGE(0x48), FEATURE,  /* speed of a joint */
    UNSIGNED16, COUNT(1), USAGE(0x49), FEATURE,  /* stall current */
                COUNT(1), USAGE(0x4A), FEATURE,  /* stall time */

    0xC0,  /* end of the collection */
};
/* clang-format on */

const size_t riffler_pen_descriptor_size = sizeof riffler_pen_descriptor;
