// The loop that ties the logic to a board, on a board made of queues.
#include <gtest/gtest.h>

#include <deque>

#include "device/firmware/pen_board.h"
#include "device/pens.hpp"

namespace riffler::device::loop_test {
namespace {

struct FakeBoard {
  std::uint32_t now = 0xFFFFF000;  // wraps soon
  std::deque<Bytes> from_host;
  std::vector<Bytes> to_host;
  riffler_pen_sensors sensors{};
  std::vector<riffler_pen_drive> drives;
  std::string order;

  FakeBoard() {
    sensors.ready = 1;
    for (std::int16_t& t : sensors.temperature_dc) t = 250;
  }

  riffler_pen_board interface() {
    const auto self = [](void* context) { return static_cast<FakeBoard*>(context); };
    static const auto kSelf = self;
    riffler_pen_board board{};
    board.context = this;
    board.clock_us = [](void* context) { return kSelf(context)->now; };
    board.receive = [](void* context, std::uint8_t* bytes, std::size_t capacity) -> std::size_t {
      FakeBoard& b = *kSelf(context);
      if (b.from_host.empty()) return 0;
      const Bytes report = b.from_host.front();
      b.from_host.pop_front();
      b.order += 'r';
      std::copy_n(report.begin(), std::min(capacity, report.size()), bytes);
      return report.size();
    };
    board.sense = [](void* context, riffler_pen_sensors* out) {
      kSelf(context)->order += 's';
      *out = kSelf(context)->sensors;
    };
    board.drive = [](void* context, const riffler_pen_drive* drive) {
      kSelf(context)->order += 'd';
      kSelf(context)->drives.push_back(*drive);
    };
    board.send = [](void* context, const std::uint8_t* bytes, std::size_t size) {
      kSelf(context)->order += 'o';
      kSelf(context)->to_host.emplace_back(bytes, bytes + size);
    };
    board.feed = [](void* context) { kSelf(context)->order += 'f'; };
    return board;
  }
};

Bytes host_report(std::uint16_t sequence, bool enable, std::int16_t current = 0) {
  riffler_pen_output report{};
  report.enable = enable;
  report.sequence = sequence;
  report.commands[0] = current;
  return encoded(report);
}

riffler_pen_input read(const Bytes& bytes) {
  riffler_pen_input report{};
  EXPECT_EQ(decode(bytes, report), RIFFLER_PEN_OK);
  return report;
}

TEST(PenLoop, GoesFromBootToForceOverTheBoard) {
  FakeBoard board;
  const riffler_pen_config config = reference();
  const riffler_pen_board interface = board.interface();
  riffler_pen_loop loop;
  riffler_pen_loop_start(&loop, &config, &interface);
  std::uint16_t sequence = 0;
  for (int turn = 0; turn < 4 * 600; ++turn) {  // 4 kHz
    board.now += 250;
    for (std::int32_t& counter : board.sensors.counters) counter += turn % 2 ? 1 : -1;
    if (turn % 4 == 0) board.from_host.push_back(host_report(++sequence, turn >= 40, 800));
    riffler_pen_loop_turn(&loop);
    for (int k = 0; k < RIFFLER_PEN_JOINTS; ++k) board.sensors.current_ma[k] = board.drives.back().current_ma[k];
  }
  EXPECT_EQ(board.drives.size(), 2400U);
  EXPECT_EQ(board.drives.back().current_ma[0], 800);
  ASSERT_EQ(board.to_host.size(), 600U) << "one report a millisecond";
  for (std::size_t k = 1; k < board.to_host.size(); ++k) {
    const riffler_pen_input a = read(board.to_host[k - 1]), b = read(board.to_host[k]);
    ASSERT_EQ(static_cast<std::uint16_t>(b.sequence - a.sequence), 1);
    ASSERT_EQ(b.time_us - a.time_us, 1000U);
  }
  EXPECT_EQ(read(board.to_host.back()).state, RIFFLER_PEN_ACTIVE);
  EXPECT_EQ(board.order.substr(0, 4), "rsdf") << "reports, sensors, motors; the watchdog is fed when all is done";
}

TEST(PenLoop, AFloodOfReportsDoesNotKeepThePenFromItsMotors) {
  FakeBoard board;
  const riffler_pen_config config = reference();
  const riffler_pen_board interface = board.interface();
  riffler_pen_loop loop;
  riffler_pen_loop_start(&loop, &config, &interface);
  for (int k = 0; k < 100; ++k) board.from_host.emplace_back(Bytes(300, 0x02));
  board.now += 1000;
  riffler_pen_loop_turn(&loop);
  EXPECT_EQ(board.from_host.size(), 92U);
  EXPECT_EQ(board.drives.size(), 1U);
  EXPECT_EQ(read(board.to_host.back()).refused_count, 8) << "too long, and none read beyond what fits";
}

TEST(PenLoop, AfterALateTurnReportsDoNotComeInABurst) {
  FakeBoard board;
  const riffler_pen_config config = reference();
  const riffler_pen_board interface = board.interface();
  riffler_pen_loop loop;
  riffler_pen_loop_start(&loop, &config, &interface);
  board.now += 10'000'000;
  riffler_pen_loop_turn(&loop);
  EXPECT_EQ(board.to_host.size(), 1U);
  for (int k = 0; k < 8; ++k) {
    board.now += 125;
    riffler_pen_loop_turn(&loop);
  }
  EXPECT_EQ(board.to_host.size(), 2U);
}

}  // namespace
}  // namespace riffler::device::loop_test
