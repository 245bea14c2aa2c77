#include "pen_board.h"

/* Largest number of reports per turn: a flooding host must not delay the motors. */
enum { MOST_REPORTS = 8 };

void riffler_pen_loop_start(riffler_pen_loop* loop, const riffler_pen_config* config, const riffler_pen_board* board) {
  riffler_pen_init(&loop->pen, config);
  loop->board = *board;
  loop->last_us = board->clock_us(board->context);
  loop->since_report_us = 0;
}

static void take_reports(riffler_pen_loop* loop) {
  uint8_t bytes[RIFFLER_PEN_PACKET_SIZE];
  for (int k = 0; k < MOST_REPORTS; ++k) {
    const size_t size = loop->board.receive(loop->board.context, bytes, sizeof bytes);
    if (size == 0) return;
    /* Refused reports are counted, and the host sees the count. A report that is too long is refused for its
     * length. */
    (void)riffler_pen_receive(&loop->pen, bytes, size);
  }
}

static void send_report(riffler_pen_loop* loop, uint32_t elapsed_us) {
  const uint32_t period = loop->pen.config.limits.period_us;
  /* After a late turn the next report keeps the rhythm, or starts a new one if a whole period was missed. */
  loop->since_report_us =
      loop->since_report_us > UINT32_MAX - elapsed_us ? UINT32_MAX : loop->since_report_us + elapsed_us;
  if (loop->since_report_us < period) return;
  loop->since_report_us = loop->since_report_us < 2 * (uint64_t)period ? loop->since_report_us - period : 0;
  uint8_t bytes[RIFFLER_PEN_INPUT_SIZE];
  const riffler_pen_input report = riffler_pen_report(&loop->pen);
  riffler_pen_encode_input(&report, bytes);
  loop->board.send(loop->board.context, bytes, sizeof bytes);
}

void riffler_pen_loop_turn(riffler_pen_loop* loop) {
  const riffler_pen_board* const board = &loop->board;
  const uint32_t now = board->clock_us(board->context);
  const uint32_t elapsed = now - loop->last_us;
  loop->last_us = now;
  take_reports(loop);
  riffler_pen_sensors sensors;
  board->sense(board->context, &sensors);
  const riffler_pen_drive drive = riffler_pen_step(&loop->pen, &sensors, elapsed);
  board->drive(board->context, &drive);
  send_report(loop, elapsed);
  board->feed(board->context);
}
