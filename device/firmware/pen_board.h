/* The functions that a board must provide for the firmware's logic, and the loop that connects the two.
 *
 * The loop runs forever, once every 125 µs to 1 ms; docs/device.md states what each function must do. None may
 * block. If reports arrive by interrupt, the board queues them until `receive` takes them. */
#ifndef RIFFLER_DEVICE_FIRMWARE_PEN_BOARD_H
#define RIFFLER_DEVICE_FIRMWARE_PEN_BOARD_H

#include "pen_firmware.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct riffler_pen_board {
  void* context; /* passed to each function */
  /* Time of a free-running clock in µs; wraps. */
  uint32_t (*clock_us)(void* context);
  /* Takes the oldest waiting output report off the queue and copies at most `capacity` bytes of it, its number
   * first. Returns its total size, 0 if none waits. */
  size_t (*receive)(void* context, uint8_t* bytes, size_t capacity);
  /* Reads all sensors, counters first and simultaneously. */
  void (*sense)(void* context, riffler_pen_sensors* sensors);
  /* Sets the motors. Must switch them off by itself if not called for the hardware watchdog's time. */
  void (*drive)(void* context, const riffler_pen_drive* drive);
  /* Passes an input report to the endpoint; it replaces a report still waiting there. */
  void (*send)(void* context, const uint8_t* bytes, size_t size);
  /* Feeds the hardware watchdog, which otherwise resets the processor with the motors off. */
  void (*feed)(void* context);
} riffler_pen_board;

typedef struct riffler_pen_loop {
  riffler_pen_firmware pen;
  riffler_pen_board board;
  uint32_t last_us, since_report_us;
} riffler_pen_loop;

/* Initialises the loop; `config` and `board` are copied. */
void riffler_pen_loop_start(riffler_pen_loop* loop, const riffler_pen_config* config, const riffler_pen_board* board);
/* One turn: reads reports, makes one step, sets the motors, and sends a report when due. */
void riffler_pen_loop_turn(riffler_pen_loop* loop);

#ifdef __cplusplus
}
#endif

#endif
