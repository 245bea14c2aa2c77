// A million steps of a pen whose host and sensors do anything: what must hold in each of them, kept by a judge that
// knows only what went in and what came out.
#include <gtest/gtest.h>

#include <cmath>

#include "device/pens.hpp"

namespace riffler::device::firmware_random_test {
namespace {

/// Hosts have moods: a calm one streams well-formed reports, others lose, repeat, reorder and spoil them.
struct Mood {
  int report_one_in, enable_percent, bad_one_in, fault_one_in, late_one_in;
};
constexpr Mood kMoods[] = {{1, 100, 1'000'000, 1'000'000, 1'000'000},
                           {1, 99, 50, 3000, 5000},
                           {12, 95, 20, 2000, 2000},
                           {1, 0, 100, 2000, 1000},
                           {3, 50, 5, 300, 300},
                           {60, 90, 5, 1000, 1000}};

class Judge {
 public:
  explicit Judge(const riffler_pen_config& config) : limits_(config.limits) {}

  void sent(bool taken, bool enable) {
    if (!taken) return;
    fresh_ = true;
    disabled_ |= !enable;
  }

  void check(const Pen& pen, std::uint32_t elapsed) {
    const bool pushes = riffler_pen_pushes(pen.state());
    age_ = fresh_ ? 0 : age_ + elapsed;
    if (disabled_) armed_ = true;
    bool any = false;
    const double most = limits_.rate_ma_per_ms * (elapsed / 1000.0) + 1;
    for (int k = 0; k < RIFFLER_PEN_JOINTS; ++k) {
      const int current = pen.currents()[k];
      any |= current != 0;
      ASSERT_LE(std::abs(current), limits_.peak_ma[k]);
      ASSERT_LE(pushes ? std::abs(current - last_[k]) : 0, most);
    }
    ASSERT_TRUE(pushes || !any) << "force outside ramp and active";
    ASSERT_EQ(bool(pen.drive.power), pushes);
    ASSERT_FALSE(pen.drive.power && pen.drive.brake);
    ASSERT_TRUE(!pen.drive.brake || pen.state() == RIFFLER_PEN_FAULT);
    ASSERT_TRUE(!pushes || age_ < limits_.watchdog_us) << "force without a report in the watchdog's time";
    ASSERT_TRUE(!(pushed_ && pushes && disabled_)) << "force continues after a report that disables";
    ASSERT_TRUE(!pushes || pushed_ || (armed_ && !any)) << "force began without a disable, or not from nothing";
    if (pushed_ && !pushes) armed_ = disabled_;
    ASSERT_EQ(pen.state() == RIFFLER_PEN_FAULT, pen.fault() != RIFFLER_PEN_NO_FAULT);
    ASSERT_TRUE(!faulty_ || pen.state() == RIFFLER_PEN_FAULT || disabled_) << "a fault left without a disable";
    faulty_ = pen.state() == RIFFLER_PEN_FAULT;
    pushed_ = pushes;
    forces_ += any;
    last_ = pen.currents();
    fresh_ = disabled_ = false;
  }

  int forces() const { return forces_; }

 private:
  riffler_pen_limits limits_;
  Currents last_{};
  std::uint64_t age_ = 0;
  bool fresh_ = false, disabled_ = false, armed_ = false, pushed_ = false, faulty_ = false;
  int forces_ = 0;
};

/// One of the things that sensors do when something is wrong.
void spoil(riffler_pen_sensors& sensors, stress::Random& random) {
  const int joint = random.below(RIFFLER_PEN_JOINTS);
  const auto bits = [&] { return static_cast<std::uint32_t>(random.bits()); };
  switch (random.below(6)) {
    case 0:
      sensors.counters[joint] = static_cast<std::int32_t>(bits());
      break;
    case 1:
      sensors.encoder_errors = static_cast<std::uint8_t>(bits());
      break;
    case 2:
      sensors.driver_faults = static_cast<std::uint8_t>(bits());
      break;
    case 3:
      sensors.temperature_dc[joint] = static_cast<std::int16_t>(random.one_in(2) ? bits() : bits() % 1500);
      break;
    case 4:
      sensors.current_ma[joint] = static_cast<std::int16_t>(bits());
      break;
    default:
      sensors.stopped = 1;
  }
}

riffler_pen_config any_config(stress::Random& random) {
  riffler_pen_config config = reference();
  do {
    config.limits = random_limits(random);
    // Times that a run of this length goes through.
    config.limits.period_us = 1000;
    config.limits.watchdog_us = static_cast<std::uint32_t>(random.uniform(3000, 50'000));
    config.limits.stale_us = static_cast<std::uint32_t>(random.uniform(1000, config.limits.watchdog_us));
    config.limits.ramp_us = static_cast<std::uint32_t>(random.power_of_ten(0, 5.7));
    config.limits.speed_counts_per_s = 400'000;
    config.limits.stall_ms = static_cast<std::uint16_t>(random.uniform(100, 3000));
    config.late_us = std::min(config.limits.watchdog_us, 5000U);
    for (int k = 0; k < RIFFLER_PEN_JOINTS; ++k) config.trip_ma[k] = 32767;
  } while (riffler_pen_config_problem(&config) != nullptr);
  return config;
}

TEST(PenFirmwareRandom, AMillionStepsKeepEveryPromise) {
  int steps = 0, forces = 0, faults[RIFFLER_PEN_FAULTS] = {}, visits[RIFFLER_PEN_STATES] = {};
  for (std::uint64_t run = 0; steps < 1'000'000; ++run) {
    stress::Random random(31, 0, run);
    const riffler_pen_config config = run % 3 == 0 ? reference() : any_config(random);
    Pen pen(config);
    pen.sequence = static_cast<std::uint16_t>(random.bits());
    Judge judge(config);
    Currents command{};
    Mood mood = kMoods[0];
    for (int k = 0; k < 20'000; ++k, ++steps) {
      if (k % 1000 == 0) mood = random.one_of(kMoods);
      if (random.one_in(30))
        for (std::int16_t& c : command)
          c = static_cast<std::int16_t>(random.one_in(4) ? random.below(65536) - 32768 : random.below(1800) - 900);
      for (int n = random.one_in(mood.report_one_in) ? (random.one_in(20) ? 3 : 1) : 0; n > 0; --n) {
        if (random.one_in(mood.bad_one_in)) pen.sequence = static_cast<std::uint16_t>(random.bits());
        const bool enable = random.below(100) < mood.enable_percent;
        judge.sent(pen.send(enable, command) == RIFFLER_PEN_OK, enable);
      }
      const std::uint32_t elapsed = random.one_in(mood.late_one_in)
                                        ? static_cast<std::uint32_t>(random.power_of_ten(3, 9))
                                    : random.one_in(10) ? static_cast<std::uint32_t>(random.below(3000))
                                                        : 1000;
      const riffler_pen_state before = pen.state();
      riffler_pen_sensors& s = pen.sensors;
      for (std::int32_t& counter : s.counters) counter = moved(counter, k % 2 ? 1 : -1);
      for (int j = 0; j < RIFFLER_PEN_JOINTS; ++j) s.current_ma[j] = pen.drive.current_ma[j];
      if (random.one_in(mood.fault_one_in)) spoil(s, random);
      pen.drive = riffler_pen_step(&pen.pen, &s, elapsed);
      judge.check(pen, elapsed);
      if (testing::Test::HasFatalFailure()) FAIL() << "run " << run << ", step " << k;
      if (pen.state() == RIFFLER_PEN_FAULT && before != RIFFLER_PEN_FAULT) ++faults[pen.fault()];
      ++visits[pen.state()];
      if (random.one_in(50)) {  // mends any fault
        s.encoder_errors = s.driver_faults = 0;
        s.stopped = 0;
        for (std::int16_t& t : s.temperature_dc) t = 250;
      }
      if (k % 64 == 0) {
        riffler_pen_input report{};
        ASSERT_EQ(decode(encoded(riffler_pen_report(&pen.pen)), report), RIFFLER_PEN_OK);
      }
    }
    forces += judge.forces();
  }
  EXPECT_GT(forces, 100'000) << "the run must push to be worth something";
  for (const int state : {RIFFLER_PEN_IDLE, RIFFLER_PEN_RAMP, RIFFLER_PEN_ACTIVE, RIFFLER_PEN_FAULT})
    EXPECT_GT(visits[state], 10'000) << riffler_pen_state_text(static_cast<unsigned>(state));
  for (const int fault :
       {RIFFLER_PEN_EMERGENCY_STOP, RIFFLER_PEN_DRIVER, RIFFLER_PEN_TEMPERATURE_SENSOR, RIFFLER_PEN_OVER_TEMPERATURE,
        RIFFLER_PEN_ENCODER_SIGNAL, RIFFLER_PEN_ENCODER_JUMP, RIFFLER_PEN_LATE_STEP, RIFFLER_PEN_WATCHDOG})
    EXPECT_GT(faults[fault], 5) << riffler_pen_fault_text(static_cast<unsigned>(fault));
}

TEST(PenFirmwareRandom, TheSameInputsGiveTheSameBytes) {
  const auto run = [] {
    stress::Random random(32);
    Pen pen(any_config(random));
    Bytes all;
    for (int k = 0; k < 5000; ++k) {
      Currents command;
      for (std::int16_t& c : command) c = static_cast<std::int16_t>(random.bits());
      if (!random.one_in(10)) pen.send(!random.one_in(100), command);
      pen.step();
      const Bytes bytes = encoded(riffler_pen_report(&pen.pen));
      all.insert(all.end(), bytes.begin(), bytes.end());
    }
    return all;
  };
  EXPECT_EQ(run(), run());
}

}  // namespace
}  // namespace riffler::device::firmware_random_test
