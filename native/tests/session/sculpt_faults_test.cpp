// Faults in mid-stroke, on the whole stack, with a journal: the force goes, the journal is whole, and what it replays
// is what was cut.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>

#include "dexel/volumes.hpp"
#include "riffler/session/journal_sink.hpp"
#include "riffler/session/replay.hpp"
#include "riffler/tool/cutters.hpp"
#include "session/sculpt_bench.hpp"
#include "support/effort.hpp"
#include "support/file_limit.hpp"
#include "support/temporary_file.hpp"

namespace riffler::session::sculpt_faults_test {
namespace {

using test::SculptBench;
using test::sculpting_hand;

const Tool kBall = cutters::ball(6, 30);

struct Fault {
  const char* name;
  std::function<void(SculptBench&)> begin;
  std::function<void(SculptBench&)> end;
  double within;  // s, after which no motor pushes, as long as it lasts
  bool comes_back = true;
};

void falsify(SculptBench& b, const std::function<void(riffler_pen_sensors&)>& change) {
  b.pen->on_sense = change;
}

void mend(SculptBench& b) {
  b.pen->on_sense = nullptr;
}

std::vector<Fault> faults() {
  const auto sensors = [](const char* name, const std::function<void(riffler_pen_sensors&)>& change) {
    return Fault{name, [change](SculptBench& b) { falsify(b, change); }, mend, 0.0075};
  };
  return {
      {"unplugged", [](SculptBench& b) { b.pen->unplug(); }, [](SculptBench& b) { b.pen->plug(); }, 0.0225},
      {"host dead", [](SculptBench& b) { b.alone(0.3); }, [](SculptBench&) {}, 0.0225},
      {"late by 30 ms", [](SculptBench& b) { b.alone(0.03); }, [](SculptBench&) {}, 0.0225},
      {"processor stands", [](SculptBench& b) { b.pen->halt(150'000); }, [](SculptBench&) {}, 0.0105},
      // Nobody takes it to its home posture, so its pose stays in doubt.
      {"restarted", [](SculptBench& b) { b.pen->restart(); }, [](SculptBench&) {}, 0.001, false},
      {"no reports", [](SculptBench& b) { b.pen->cable().set({.lost = 1}); },
       [](SculptBench& b) { b.pen->cable().set({}); }, 0.0275},
      {"deaf", [](SculptBench& b) { b.pen->cable().set({.lost_out = 1}); },
       [](SculptBench& b) { b.pen->cable().set({}); }, 0.0225},
      sensors("jump far", [](riffler_pen_sensors& s) { s.counters[1] += 5000; }),
      sensors("jump a little", [](riffler_pen_sensors& s) { s.counters[1] += 60; }),
      sensors("arms exchanged",
              [](riffler_pen_sensors& s) { std::swap_ranges(s.counters, s.counters + 3, s.counters + 3); }),
      sensors("emergency stop", [](riffler_pen_sensors& s) { s.stopped = 1; }),
      sensors("motor driver", [](riffler_pen_sensors& s) { s.driver_faults = 4; }),
      sensors("over current", [](riffler_pen_sensors& s) { s.current_ma[2] = -2600; }),
      sensors("hot", [](riffler_pen_sensors& s) { s.temperature_dc[5] = 900; }),
      sensors("encoder", [](riffler_pen_sensors& s) { s.encoder_errors = 2; }),
  };
}

std::unique_ptr<JournalSink> sink_to(const std::filesystem::path& path, const Volume& stock,
                                     const JournalStreamOptions& options = {}) {
  auto writer = std::make_unique<JournalWriter>(path, JournalWriter::Keep::Rules);
  writer->set_stock({stock.frame().box, stock.frame().pitch, stock.frame().directions, ""});
  writer->add_tool(1, "{}");
  return std::make_unique<JournalSink>(std::move(writer), 1, 0.01, options);
}

TEST(SculptFault, EachRemovesTheForceAndLeavesAJournalThatReplaysTheCuts) {
  const double after = test::kSanitized ? 3 : 6;  // s
  int number = 0;
  for (const Fault& fault : faults()) {
    if (test::kSanitized && number++ % 4 != 0) continue;  // SimulatedFault has all of them
    SCOPED_TRACE(fault.name);
    const Volume stock = test::sculpt_stock(0.5);
    const test::TemporaryFile file("fault.rjournal");
    const auto sink = sink_to(file.path, stock);
    SculptBench bench(sculpting_hand(6), stock, kBall, {}, sink.get());
    double pushed = 0;
    bench.pen->on_turn = [&] {
      for (const std::int16_t c : bench.pen->drive().current_ma)
        if (bench.pen->drive().power && c != 0) pushed = 1e-6 * static_cast<double>(bench.pen->time_us());
    };
    bench.run(2.5);
    const double began = bench.clock->now();
    EXPECT_GT(pushed, began - 0.1) << "the pen does not push before the fault";
    fault.begin(bench);
    bench.run(0.1);
    EXPECT_LE(pushed, began + fault.within);
    fault.end(bench);
    bench.run(0.6);
    bench.loop.reset();
    double removed = 0;
    bench.run(after, [&](const SculptTick& tick) { removed += tick.removed; });
    EXPECT_EQ(removed > 1, fault.comes_back) << "it does not work again, or should not";
    EXPECT_EQ(pushed > began + 1, fault.comes_back) << "the force does not come back, or should not";
    bench.loop.finish();
    Volume shown = stock;
    std::vector<SculptLoop::Place> places;
    bench.loop.show(shown, places, 0);
    EXPECT_TRUE(sink->close()) << sink->problem();
    EXPECT_TRUE(test::same_spans(shown, replay(read_journal(file.path), {{1, kBall}})));
  }
}

TEST(SculptFault, AFullDiskEndsTheCutTheForceGoesWithItAndBothComeBackWithRoom) {
  const Volume stock = test::sculpt_stock(0.5);
  const test::TemporaryFile file("full.rjournal");
  const auto sink = sink_to(file.path, stock, {.rows = 1000, .drain = 0.01, .sync = 1, .retry = 0.02});
  SculptBench bench(sculpting_hand(6), stock, kBall, {}, sink.get());
  // The keeper has its own clock: the hand waits for it.
  const auto run = [&](double seconds, const auto& visit) {
    for (double t = 0; t < seconds; t += 0.1) {
      bench.run(0.1, visit);
      std::this_thread::sleep_for(std::chrono::milliseconds(25));
    }
  };
  double removed = 0, last = 0, force = 0;
  const char* problem = nullptr;
  const auto visit = [&](const SculptTick& tick) {
    removed += tick.removed;
    if (tick.removed > 0) last = tick.time;
    if (tick.problem) problem = tick.problem;
    if (tick.problem && tick.time > last + 0.1) force = std::max(force, glm::length(tick.wrench.force));
  };
  run(2, visit);
  EXPECT_GT(removed, 1);
  {
    const test::FileLimit full(std::filesystem::file_size(file.path));
    run(4, visit);
    ASSERT_NE(problem, nullptr);
    EXPECT_NE(std::string(problem).find("no room"), std::string::npos);
    EXPECT_FALSE(sink->problem().empty());
    EXPECT_LT(last, 4);
    EXPECT_LT(force, 0.1);                                   // the coupling's damping, in the air
    EXPECT_EQ(read_journal(file.path).stock()->pitch, 0.5);  // whole as far as it goes
  }
  removed = 0;
  run(5, visit);
  EXPECT_GT(removed, 1);
  bench.loop.finish();
  Volume shown = stock;
  std::vector<SculptLoop::Place> places;
  bench.loop.show(shown, places, 0);
  EXPECT_TRUE(sink->close()) << sink->problem();
  EXPECT_TRUE(test::same_spans(shown, replay(read_journal(file.path), {{1, kBall}})));
}

}  // namespace
}  // namespace riffler::session::sculpt_faults_test
