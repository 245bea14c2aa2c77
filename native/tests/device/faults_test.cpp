// Injected faults: each takes all force away in the step that sees it, is reported with its joint, stays until the host
// disables and the cause is gone, and force comes back through the ramp only.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "device/pens.hpp"

namespace riffler::device::faults_test {
namespace {

const Currents kCommand = {300, -200, 100, 0, 50, -400};

struct Injection {
  std::string name;
  std::function<void(Pen&)> inject;  // ends with the step that must see it
  int fault;
  int joint = RIFFLER_PEN_NO_JOINT;
  bool brakes = true;
  std::function<void(Pen&)> mend = [](Pen&) {};
};

/// Steps with reports, but only the given joint's counter stands.
void push_with_dead_encoder(Pen& pen, int joint, const Currents& command, int steps) {
  for (int k = 0; k < steps; ++k) {
    const std::int32_t stands = pen.sensors.counters[joint];
    for (std::int32_t& counter : pen.sensors.counters) counter += k % 2 ? 1 : -1;
    pen.sensors.counters[joint] = stands;
    pen.send(true, command);
    pen.still_step();
  }
}

std::vector<Injection> injections() {
  const auto step_with = [](auto change) {
    return [change](Pen& pen) {
      pen.send(true, kCommand);
      change(pen.sensors);
      pen.step();
    };
  };
  const auto mend = [](auto change) { return [change](Pen& pen) { change(pen.sensors); }; };
  using S = riffler_pen_sensors;
  return {
      {"no reports",
       [](Pen& p) {
         for (int k = 0; k < 20; ++k) p.step();
       },
       RIFFLER_PEN_WATCHDOG},
      {"reports 40 ms late",
       [](Pen& p) {
         for (int k = 0; k < 40 && p.state() == RIFFLER_PEN_ACTIVE; ++k) p.step();
       },
       RIFFLER_PEN_WATCHDOG},
      {"the same report again and again",
       [](Pen& p) {
         for (int k = 0; k < 20; ++k) {
           --p.sequence;
           p.turn(true, kCommand);
         }
       },
       RIFFLER_PEN_WATCHDOG},
      {"reports from a queue that is old",
       [](Pen& p) {
         p.sequence = static_cast<std::uint16_t>(p.sequence - 500);
         for (int k = 0; k < 20; ++k) p.turn(true, kCommand);
       },
       RIFFLER_PEN_WATCHDOG},
      {"reports of another number",
       [](Pen& p) {
         for (int k = 0; k < 20; ++k) {
           Bytes bytes(RIFFLER_PEN_OUTPUT_SIZE, 0);
           bytes[0] = 5;
           riffler_pen_receive(&p.pen, bytes.data(), bytes.size());
           p.step();
         }
       },
       RIFFLER_PEN_WATCHDOG},
      {"merged reports",
       [](Pen& p) {
         for (int k = 0; k < 20; ++k) {
           Bytes bytes(2 * RIFFLER_PEN_OUTPUT_SIZE, 0);
           bytes[0] = RIFFLER_PEN_OUTPUT_ID;
           riffler_pen_receive(&p.pen, bytes.data(), bytes.size());
           p.step();
         }
       },
       RIFFLER_PEN_WATCHDOG},
      {"a step that takes too long", [](Pen& p) { p.turn(true, kCommand, 5001); }, RIFFLER_PEN_LATE_STEP},
      {"a clock that runs round", [](Pen& p) { p.turn(true, kCommand, UINT32_MAX); }, RIFFLER_PEN_LATE_STEP},
      {"a counter that jumps", step_with([](S& s) { s.counters[2] += 420; }), RIFFLER_PEN_ENCODER_JUMP, 2},
      {"a counter that jumps back", step_with([](S& s) { s.counters[5] -= 100'000; }), RIFFLER_PEN_ENCODER_JUMP, 5},
      {"a counter that jumps half way round", step_with([](S& s) { s.counters[1] = INT32_MIN; }),
       RIFFLER_PEN_ENCODER_JUMP, 1},
      {"counters that begin again at nothing",
       [](Pen& p) {
         for (int k = 0; k < 40; ++k) {
           p.sensors.counters[0] += 300;
           p.turn(true, kCommand);
         }
         p.sensors.counters[0] = 0;
         p.turn(true, kCommand);
       },
       RIFFLER_PEN_ENCODER_JUMP, 0},
      {"an encoder's error line", step_with([](S& s) { s.encoder_errors = 1 << 3; }), RIFFLER_PEN_ENCODER_SIGNAL, 3,
       true, mend([](S& s) { s.encoder_errors = 0; })},
      {"a frozen counter",
       [](Pen& p) {
         const Currents hard = {0, 0, 0, 0, 1200, 0};
         for (int k = 0; k < 20; ++k) p.turn(true, hard);
         push_with_dead_encoder(p, 4, hard, 2600);
       },
       RIFFLER_PEN_STALL, 4},
      {"current without end", step_with([](S&) {}), RIFFLER_PEN_OVER_CURRENT, 1, false},
      {"a driver's fault line", step_with([](S& s) { s.driver_faults = 0x30; }), RIFFLER_PEN_DRIVER, 4, false,
       mend([](S& s) { s.driver_faults = 0; })},
      {"a motor that is too hot", step_with([](S& s) { s.temperature_dc[0] = 851; }), RIFFLER_PEN_OVER_TEMPERATURE, 0,
       true, mend([](S& s) { s.temperature_dc[0] = 750; })},
      {"an open temperature sensor", step_with([](S& s) { s.temperature_dc[3] = INT16_MIN; }),
       RIFFLER_PEN_TEMPERATURE_SENSOR, 3, true, mend([](S& s) { s.temperature_dc[3] = 250; })},
      {"a shorted temperature sensor", step_with([](S& s) { s.temperature_dc[5] = 1501; }),
       RIFFLER_PEN_TEMPERATURE_SENSOR, 5, true, mend([](S& s) { s.temperature_dc[5] = 250; })},
      {"the emergency stop", step_with([](S& s) { s.stopped = 1; }), RIFFLER_PEN_EMERGENCY_STOP, RIFFLER_PEN_NO_JOINT,
       true, mend([](S& s) { s.stopped = 0; })},
      {"an amplifier that does not follow", [](Pen&) {}, RIFFLER_PEN_DRIVE_MISMATCH, 2, false},
  };
}

/// The two faults that need a current other than the commanded one.
void inject(const Injection& injection, Pen& pen) {
  if (injection.fault == RIFFLER_PEN_OVER_CURRENT) {
    pen.send(true, kCommand);
    pen.sensors.current_ma[1] = -2501;
    pen.drive = riffler_pen_step(&pen.pen, &pen.sensors, 1000);
  } else if (injection.fault == RIFFLER_PEN_DRIVE_MISMATCH) {
    for (int k = 0; k < 21; ++k) {
      ASSERT_EQ(pen.state(), RIFFLER_PEN_ACTIVE) << "spikes of " << k << " ms are borne";
      pen.send(true, kCommand);
      pen.sensors.current_ma[2] = 100 + 501;
      pen.drive = riffler_pen_step(&pen.pen, &pen.sensors, 1000);
    }
  } else {
    injection.inject(pen);
  }
}

TEST(PenFaults, EachRemovesForceInTheStepThatDetectsIt) {
  for (const Injection& injection : injections()) {
    SCOPED_TRACE(injection.name);
    Pen pen;
    pen.activate(kCommand);
    ASSERT_EQ(pen.state(), RIFFLER_PEN_ACTIVE);
    ASSERT_EQ(pen.currents(), kCommand);
    inject(injection, pen);
    EXPECT_EQ(pen.state(), RIFFLER_PEN_FAULT);
    EXPECT_STREQ(riffler_pen_fault_text(pen.pen.fault), riffler_pen_fault_text(injection.fault));
    EXPECT_EQ(pen.pen.fault_joint, injection.joint);
    EXPECT_EQ(pen.pen.fault_count, 1);
    EXPECT_EQ(pen.currents(), Currents{});
    EXPECT_FALSE(pen.drive.power);
    EXPECT_EQ(bool(pen.drive.brake), injection.brakes) << "a bridge that may be broken is only switched off";
    riffler_pen_input report{};
    EXPECT_EQ(decode(encoded(riffler_pen_report(&pen.pen)), report), RIFFLER_PEN_OK);
    EXPECT_EQ(report.fault, injection.fault);
  }
}

TEST(PenFaults, EachIsDetectedInTheRampToo) {
  for (const Injection& injection : injections()) {
    if (injection.fault == RIFFLER_PEN_STALL || injection.fault == RIFFLER_PEN_DRIVE_MISMATCH)
      continue;  // need current
    SCOPED_TRACE(injection.name);
    Pen pen;
    pen.step();
    pen.turn(false);
    for (int k = 0; k < 100; ++k) pen.turn(true, kCommand);
    ASSERT_EQ(pen.state(), RIFFLER_PEN_RAMP);
    inject(injection, pen);
    for (int k = 0; k < 25 && injection.name.ends_with("late"); ++k) pen.step();
    EXPECT_EQ(pen.state(), RIFFLER_PEN_FAULT);
    EXPECT_EQ(pen.fault(), injection.fault);
    EXPECT_EQ(pen.currents(), Currents{});
  }
}

TEST(PenFaults, EachStaysUntilTheHostDisablesAndTheCauseIsGone) {
  for (const Injection& injection : injections()) {
    SCOPED_TRACE(injection.name);
    Pen pen;
    pen.activate(kCommand);
    inject(injection, pen);
    ASSERT_EQ(pen.state(), RIFFLER_PEN_FAULT);
    for (int k = 0; k < 100; ++k) {
      pen.turn(true, kCommand);
      ASSERT_EQ(pen.fault(), injection.fault) << "a host that keeps enabling has not seen it";
      ASSERT_EQ(pen.currents(), Currents{});
    }
    const bool cause_stays = pen.sensors.stopped || pen.sensors.encoder_errors || pen.sensors.driver_faults ||
                             injection.joint == 0 || injection.fault == RIFFLER_PEN_TEMPERATURE_SENSOR;
    if (cause_stays && injection.fault != RIFFLER_PEN_ENCODER_JUMP) {
      pen.turn(false);
      EXPECT_EQ(pen.fault(), injection.fault) << "the cause is still there";
    }
    injection.mend(pen);
    pen.turn(true, kCommand);
    EXPECT_EQ(pen.fault(), injection.fault);
    pen.turn(false);
    EXPECT_EQ(pen.state(), RIFFLER_PEN_IDLE);
    EXPECT_EQ(pen.fault(), RIFFLER_PEN_NO_FAULT);
    EXPECT_FALSE(pen.drive.brake);
    pen.turn(true, kCommand);
    EXPECT_EQ(pen.state(), RIFFLER_PEN_RAMP);
    EXPECT_EQ(pen.currents(), Currents{});
    for (int k = 0; k < 500; ++k) {
      const Currents last = pen.currents();
      pen.turn(true, kCommand);
      for (int j = 0; j < RIFFLER_PEN_JOINTS; ++j) ASSERT_GE(std::abs(pen.currents()[j]), std::abs(last[j]));
    }
    EXPECT_EQ(pen.state(), RIFFLER_PEN_ACTIVE);
    EXPECT_EQ(pen.currents(), kCommand);
  }
}

TEST(PenFaults, LateReportsDecayForceBeforeTheyTrip) {
  for (int late = 2; late <= 40; ++late) {
    Pen pen;
    pen.activate(kCommand);
    pen.turn(true, kCommand);
    for (int k = 1; k < late; ++k) pen.step();
    EXPECT_EQ(pen.state(), late <= 20 ? RIFFLER_PEN_ACTIVE : RIFFLER_PEN_FAULT) << late;
    const double part = late - 1 <= 5 ? 1 : late > 20 ? 0 : (20.0 - (late - 1)) / 15;
    EXPECT_NEAR(pen.currents()[0], kCommand[0] * part, 1) << late;
  }
}

/// A hand on the grip: joints yield by current over stiffness, once the change of that exceeds their friction.
struct LeaningHand {
  double counts_per_ma, friction_ma;
  std::array<double, RIFFLER_PEN_JOINTS> at{};

  void move(Pen& pen) {
    for (std::size_t k = 0; k < at.size(); ++k) {
      const double current = pen.drive.current_ma[k], low = current - friction_ma, high = current + friction_ma;
      at[k] = std::clamp(at[k], low, high);  // mA whose spring the hand's is
      pen.sensors.counters[k] = static_cast<std::int32_t>(std::floor(counts_per_ma * at[k]));
    }
  }
};

/// Without a tremor, for a minute: force breathes by what friction hides, and no more.
TEST(PenFaults, AHandThatHoldsStillUnderForceIsNotAStall) {
  const Currents lean = {450, -480, 100, 0, 450, -400};
  for (const double friction : {0.0, 20.0, 100.0, 150.0}) {
    SCOPED_TRACE(friction);
    Pen pen;
    LeaningHand hand{0.1, friction};
    double least = 1e9;
    pen.step();
    pen.send(false);
    pen.still_step();
    for (int k = 0; k < 60'000; ++k) {
      hand.move(pen);
      pen.send(true, lean);
      pen.still_step();
      ASSERT_EQ(pen.fault(), RIFFLER_PEN_NO_FAULT) << k;
      if (k > 1000) least = std::min(least, 1.0 * pen.currents()[0]);
    }
    EXPECT_EQ(pen.state(), RIFFLER_PEN_ACTIVE);
    // To and fro through the friction of the one that pushes with least, and a count.
    EXPECT_GE(least, 450 * (1 - (2 * friction + 25) / 400));
  }
}

TEST(PenFaults, DeadEncodersUnderForceFadeItAndAreAStall) {
  const Currents hard = {450, -480, 100, 0, 450, -400};
  Pen pen;
  pen.activate(hard);
  int eased = 0;
  Currents last = pen.currents();
  for (int k = 0; k < 2600 && pen.state() == RIFFLER_PEN_ACTIVE; ++k) {
    pen.send(true, hard);
    pen.still_step();
    if (pen.state() == RIFFLER_PEN_FAULT) break;
    for (int j = 0; j < RIFFLER_PEN_JOINTS; ++j) {
      ASSERT_LE(std::abs(pen.currents()[j]), std::abs(last[j]));
      ASSERT_LE(std::abs(last[j] - pen.currents()[j]), 3);
    }
    last = pen.currents();
    eased += (pen.pen.flags & RIFFLER_PEN_FLAG_LIMITED) != 0;
  }
  EXPECT_EQ(pen.fault(), RIFFLER_PEN_STALL);
  EXPECT_EQ(last, Currents{});
  EXPECT_NEAR(eased, 600, 3);
}

/// The force comes back as slowly as it went, from wherever a count was seen.
TEST(PenFaults, AReportDuringTheDecayRestoresTheForce) {
  const Currents hard = {0, 0, 0, 0, 480, 0};
  Pen pen;
  pen.activate(hard);
  for (int k = 0; k < 2250; ++k) pen.send(true, hard), pen.still_step();
  const int low = pen.currents()[4];
  EXPECT_NEAR(low, 240, 10);
  ++pen.sensors.counters[4];
  for (int k = 0; k < 252; ++k) {
    const int before = pen.currents()[4];
    pen.send(true, hard), pen.still_step();
    ASSERT_GE(pen.currents()[4], before);
    ASSERT_LE(pen.currents()[4] - before, 2);
  }
  EXPECT_NEAR(pen.currents()[4], 480, 10);
  EXPECT_EQ(pen.pen.eased_us, 0U);
}

TEST(PenFaults, TheFirstCauseIsKeptWhenOthersFollow) {
  Pen pen;
  pen.activate(kCommand);
  pen.sensors.encoder_errors = 2;
  pen.turn(true, kCommand);
  pen.sensors.stopped = 1;
  pen.turn(true, kCommand);
  EXPECT_EQ(pen.fault(), RIFFLER_PEN_ENCODER_SIGNAL);
  pen.sensors.encoder_errors = 0;
  pen.turn(false);
  EXPECT_EQ(pen.state(), RIFFLER_PEN_FAULT) << "another cause is there by now";
  pen.sensors.stopped = 0;
  pen.turn(false);
  EXPECT_EQ(pen.state(), RIFFLER_PEN_IDLE);
}

TEST(PenFaults, TheLowestNumberOfSeveralInOneStepIsReported) {
  Pen pen;
  pen.activate(kCommand);
  pen.sensors.driver_faults = 1;
  pen.sensors.stopped = 1;
  pen.sensors.temperature_dc[2] = 1000;
  pen.turn(true, kCommand, 10'000);
  EXPECT_EQ(pen.fault(), RIFFLER_PEN_EMERGENCY_STOP);
}

TEST(PenFaults, AHotMotorMustCoolByTenDegrees) {
  Pen pen;
  pen.activate(kCommand);
  pen.sensors.temperature_dc[1] = 851;
  pen.turn(true, kCommand);
  for (const int dc : {850, 800, 751}) {
    pen.sensors.temperature_dc[1] = static_cast<std::int16_t>(dc);
    pen.turn(false);
    EXPECT_EQ(pen.fault(), RIFFLER_PEN_OVER_TEMPERATURE) << dc;
  }
  pen.sensors.temperature_dc[1] = 750;
  pen.turn(false);
  EXPECT_EQ(pen.state(), RIFFLER_PEN_IDLE);
}

TEST(PenFaults, ATemperatureSensorThatReadsTheImpossibleIsBroken) {
  for (const int dc : {-400, -401, 1500, 1501}) {
    riffler_pen_config config = reference();
    config.hottest_dc = 1500;
    Pen pen(config);
    pen.activate(kCommand);
    pen.sensors.temperature_dc[4] = static_cast<std::int16_t>(dc);
    pen.turn(true, kCommand);
    EXPECT_EQ(pen.fault(), dc < -400 || dc > 1500 ? RIFFLER_PEN_TEMPERATURE_SENSOR : RIFFLER_PEN_NO_FAULT) << dc;
  }
}

TEST(PenFaults, AMotionFasterThanTheArmIsAJump) {
  for (const std::uint32_t tick : {125U, 1000U, 4000U}) {
    const auto most = static_cast<std::int32_t>(400'000ULL * tick / 1'000'000 + 8);
    for (const int sign : {1, -1}) {
      Pen pen;
      pen.activate();
      pen.sensors.counters[3] += sign * most;
      pen.send(true);
      pen.still_step(tick);
      EXPECT_EQ(pen.state(), RIFFLER_PEN_ACTIVE) << tick;
      pen.sensors.counters[3] += sign * (most + 1);
      pen.send(true);
      pen.still_step(tick);
      EXPECT_EQ(pen.fault(), RIFFLER_PEN_ENCODER_JUMP) << tick;
    }
  }
}

TEST(PenFaults, AHandThatHoldsStillIsNotAStall) {
  Pen pen;
  pen.activate();
  const Currents hard = {0, 0, 0, 0, 1200, 0}, soft = {0, 0, 0, 0, 399, 0};
  for (int k = 0; k < 20; ++k) pen.turn(true, hard);
  for (int k = 0; k < 10; ++k) {
    push_with_dead_encoder(pen, 4, hard, 1900);
    ASSERT_EQ(pen.state(), RIFFLER_PEN_ACTIVE);
    pen.turn(true, hard);  // one count
  }
  push_with_dead_encoder(pen, 4, soft, 10'000);
  EXPECT_EQ(pen.state(), RIFFLER_PEN_ACTIVE);
}

TEST(PenFaults, BrakedWindingsMayCarryInducedCurrent) {
  Pen pen;
  pen.activate(kCommand);
  for (int k = 0; k < 20; ++k) pen.step();
  ASSERT_TRUE(pen.drive.brake);
  for (int k = 0; k < 100; ++k) {
    pen.sensors.current_ma[0] = 800;
    pen.send(k >= 99 ? false : true);
    pen.drive = riffler_pen_step(&pen.pen, &pen.sensors, 1000);
  }
  EXPECT_EQ(pen.state(), RIFFLER_PEN_IDLE);
}

TEST(PenFaults, UncommandedCurrentIsAFaultAtRestToo) {
  Pen pen;
  pen.step();
  pen.step();
  ASSERT_EQ(pen.state(), RIFFLER_PEN_IDLE);
  for (int k = 0; k < 21; ++k) {
    pen.sensors.current_ma[5] = -600;
    pen.drive = riffler_pen_step(&pen.pen, &pen.sensors, 1000);
  }
  EXPECT_EQ(pen.fault(), RIFFLER_PEN_DRIVE_MISMATCH);
  EXPECT_EQ(pen.pen.fault_joint, 5);
}

TEST(PenFaults, OnlyARestartLeavesADamagedState) {
  Pen pen;
  pen.activate(kCommand);
  pen.pen.state = static_cast<riffler_pen_state>(7);
  pen.turn(true, kCommand);
  EXPECT_EQ(pen.fault(), RIFFLER_PEN_INTERNAL);
  EXPECT_EQ(pen.currents(), Currents{});
  for (int k = 0; k < 100; ++k) {
    pen.turn(k % 2, kCommand);
    ASSERT_EQ(pen.fault(), RIFFLER_PEN_INTERNAL);
  }
}

TEST(PenFaults, NoSensorMattersBeforeThePenIsReady) {
  Pen pen;
  pen.sensors.ready = 0;
  pen.sensors.stopped = 1;
  pen.sensors.encoder_errors = pen.sensors.driver_faults = 0x3F;
  pen.sensors.temperature_dc[0] = INT16_MAX;
  pen.step(UINT32_MAX);
  EXPECT_EQ(pen.state(), RIFFLER_PEN_BOOT);
  pen.sensors.ready = 1;
  pen.step();
  EXPECT_EQ(pen.state(), RIFFLER_PEN_IDLE);
  pen.step();
  EXPECT_EQ(pen.fault(), RIFFLER_PEN_EMERGENCY_STOP);
}

}  // namespace
}  // namespace riffler::device::faults_test
