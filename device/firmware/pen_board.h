/* What a board has to give for the firmware's logic to run on it, and the loop that ties the two together.
 *
 * The loop is called for ever, once every 125 µs to 1 ms; docs/device.md says what each call must do. None of them may
 * block. Where reports arrive by interrupt, the board keeps them in a queue of its own until `receive` asks.
 */
#ifndef RIFFLER_DEVICE_FIRMWARE_PEN_BOARD_H
#define RIFFLER_DEVICE_FIRMWARE_PEN_BOARD_H

#include "pen_firmware.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct riffler_pen_board {
  void* context; /* given to each of the calls */
  /* A free-running clock; wraps. */
  uint32_t (*clock_us)(void* context);
  /* Takes the oldest waiting output report off the queue and copies at most `capacity` bytes of it, its number first.
   * Returns its whole size, 0 if none waits. */
  size_t (*receive)(void* context, uint8_t* bytes, size_t capacity);
  /* Reads all sensors, counters first and at one moment. */
  void (*sense)(void* context, riffler_pen_sensors* sensors);
  /* Sets the motors. Must switch them off by itself where it is not called for the hardware watchdog's time. */
  void (*drive)(void* context, const riffler_pen_drive* drive);
  /* Hands an input report to the endpoint; if the last is still waiting there, this one takes its place. */
  void (*send)(void* context, const uint8_t* bytes, size_t size);
  /* Feeds the hardware watchdog, whose end resets the processor with the motors off. */
  void (*feed)(void* context);
} riffler_pen_board;

typedef struct riffler_pen_loop {
  riffler_pen_firmware pen;
  riffler_pen_board board;
  uint32_t last_us, since_report_us;
} riffler_pen_loop;

void riffler_pen_loop_start(riffler_pen_loop* loop, const riffler_pen_config* config, const riffler_pen_board* board);
/* One turn: reports in, one step, motors, a report out when its time has come. */
void riffler_pen_loop_turn(riffler_pen_loop* loop);

#ifdef __cplusplus
}
#endif

#endif
