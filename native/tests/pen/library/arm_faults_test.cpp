// The faults of the simulated pen's suite (pen/simulated) that other makers' arms can have, on each of these arms with
// everything between: driver, library or service, and arm. The other faults are those of a Riffler pen's own board
// (currents, temperatures, encoders, stall, redundant counters, a restart without a report), which a library or service
// does not show.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "pen/haply/inverse_service.hpp"
#include "pen/library/library_test.hpp"
#include "pen/library/stub_dhd.hpp"
#include "pen/library/stub_hd.hpp"
#include "riffler/haptics/safety.hpp"
#include "riffler/pen/registry.hpp"
#include "support/stub_libraries.hpp"

namespace riffler::pen::arm_faults_test {
namespace {

using namespace std::chrono_literals;
using haptics::Cause;

constexpr double kForce = 1;  // N upwards

/// A maker's arm, and what may happen to it.
struct Arm {
  virtual ~Arm() = default;
  virtual const char* kind() const = 0;
  virtual double force() = 0;        ///< N upwards, now
  virtual void move(double mm) = 0;  ///< at once
  virtual void speed(double mm_per_s) = 0;
  virtual void plug(bool in) = 0;
  virtual void power(bool on) = 0;
  virtual void stop_answering(bool stops) = 0;  ///< the library or the service
};

class ForceDimensionArm final : public Arm {
 public:
  ForceDimensionArm() { ::setenv("RIFFLER_LIBDHD", test::stub_dhd_path(), 1); }
  ~ForceDimensionArm() override { ::unsetenv("RIFFLER_LIBDHD"); }
  const char* kind() const override { return "force-dimension"; }
  double force() override {
    test::watch(arm());
    return arm().force[2];
  }
  void move(double mm) override { arm().position[0] = arm().position[0] + 1e-3 * mm; }
  void speed(double mm_per_s) override { arm().velocity[0] = 1e-3 * mm_per_s; }
  void plug(bool in) override { arm().plugged = in; }
  void power(bool on) override { arm().power = on; }
  void stop_answering(bool stops) override {
    arm().hangs = stops;
    if (!stops) arm().open = false;  // the system closes what a killed program had open
  }

 private:
  test::StubArm& arm() { return state_->arms[0]; }
  const test::StubState<test::StubDhd> state_;
};

class TouchArm final : public Arm {
 public:
  TouchArm() { ::setenv("RIFFLER_LIBHD", test::stub_hd_path(), 1); }
  ~TouchArm() override { ::unsetenv("RIFFLER_LIBHD"); }
  const char* kind() const override { return "touch"; }
  double force() override { return arm().force[1]; }
  void move(double mm) override { arm().position[0] = arm().position[0] + mm; }
  void speed(double mm_per_s) override { arm().velocity[0] = mm_per_s; }
  void plug(bool in) override { arm().plugged = in; }
  void power(bool on) override { arm().output = on; }
  void stop_answering(bool stops) override { arm().stalled = stops; }

 private:
  test::StubTouch& arm() { return state_->arms[0]; }
  const test::StubState<test::StubHd> state_;
};

class HaplyArm final : public Arm {
 public:
  HaplyArm() { ::setenv("RIFFLER_HAPLY_PORT", std::to_string(service_.port()).c_str(), 1); }
  ~HaplyArm() override { ::unsetenv("RIFFLER_HAPLY_PORT"); }
  const char* kind() const override { return "haply"; }
  double force() override { return service_.force(); }
  void move(double mm) override {
    change([&](auto& arm) { arm.position[0] += 1e-3 * mm; });
  }
  void speed(double mm_per_s) override {
    change([&](auto& arm) { arm.velocity[0] = 1e-3 * mm_per_s; });
  }
  void plug(bool in) override {
    change([&](auto& arm) { arm.plugged = in; });
  }
  void power(bool on) override {
    change([&](auto& arm) { arm.power_supply = on; });
  }
  void stop_answering(bool stops) override {
    service_.with([&](test::InverseService::State& s) { s.lose_every = stops ? 1 : 0; });
  }

 private:
  void change(const auto& f) {
    service_.with([&](test::InverseService::State& s) { f(s.arms[0]); });
  }
  test::InverseService service_;
};

/// Pushes upwards through the gate of all forces, as a session does.
class Pushing final : public PenStep {
 public:
  haptics::SafeWrench step(const PenSample& sample, double now, double dt) noexcept override {
    if (reset.exchange(false)) safety_.reset();
    if (!std::exchange(on_, true)) safety_.switch_on();
    safety_.observe({.dt = dt,
                     .age = now - sample.time,
                     .pose = sample.pose,
                     .twist = {sample.velocity, sample.turning},
                     .homed = sample.homed,
                     .dead_man = true,
                     .device_fault = sample.fault});
    if (dt == 0) safety_.interrupt();
    const haptics::SafeWrench out = safety_.release({{0, 0, newtons.load()}, {}});
    cause = safety_.cause();
    if (stands) std::this_thread::sleep_for(300ms);  // and then the wrench is old
    return out;
  }

  std::atomic<double> newtons{kForce};
  std::atomic<bool> stands{false}, reset{false};
  std::atomic<Cause> cause{Cause::None};

 private:
  haptics::Safety safety_{haptics::SafetySettings{}};
  bool on_ = false;
};

struct Fault {
  const char* name;
  std::function<void(Arm&, Pushing&)> begin, end;
  std::vector<Cause> causes;  ///< one of which the gate names; none for a connection that ends
  bool heals = false;         ///< without a reset
};

std::vector<Fault> faults() {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const auto nothing = [](Arm&, Pushing&) {};
  const auto pushes = [](double newtons) { return [newtons](Arm&, Pushing& p) { p.newtons = newtons; }; };
  return {
      {"jump", [](Arm& arm, Pushing&) { arm.move(50); }, nothing, {Cause::Jump}},
      {"small jump", [](Arm& arm, Pushing&) { arm.move(-8); }, nothing, {Cause::Jump}},
      {"speed",
       [](Arm& arm, Pushing&) { arm.speed(2000); },
       [](Arm& arm, Pushing&) { arm.speed(0); },
       {Cause::Overspeed},
       true},
      {"no power",
       [](Arm& arm, Pushing&) { arm.power(false); },
       [](Arm& arm, Pushing&) { arm.power(true); },
       {Cause::NotHomed, Cause::DeviceFault}},
      {"no answers",
       [](Arm& arm, Pushing&) { arm.stop_answering(true); },
       [](Arm& arm, Pushing&) { arm.stop_answering(false); },
       {},
       true},
      {"a step that stands",
       [](Arm&, Pushing& p) { p.stands = true; },
       [](Arm&, Pushing& p) { p.stands = false; },
       {},
       true},
      {"no number", pushes(kNan), pushes(kForce), {Cause::BadWrench}},
      {"too much", pushes(1e6), pushes(kForce), {Cause::Excess}},
  };
}

bool soon(const std::function<bool()>& done) {
  for (const auto end = std::chrono::steady_clock::now() + 10s; std::chrono::steady_clock::now() < end;) {
    if (done()) return true;
    std::this_thread::sleep_for(1ms);
  }
  return done();
}

template <class A>
class ArmFault : public ::testing::Test {};
using Arms = ::testing::Types<ForceDimensionArm, TouchArm, HaplyArm>;
TYPED_TEST_SUITE(ArmFault, Arms, );

TYPED_TEST(ArmFault, EachRemovesTheForceWhichReturnsThroughTheRamp) {
  TypeParam arm;
  const auto pen = open_pen(arm.kind());
  const auto push = std::make_shared<Pushing>();
  pen->set_step(push);
  const auto pushes = [&] { return soon([&] { return arm.force() > 0.95 * kForce; }); };
  for (const Fault& fault : faults()) {
    SCOPED_TRACE(fault.name);
    ASSERT_TRUE(pushes());
    fault.begin(arm, *push);
    EXPECT_TRUE(soon([&] { return arm.force() == 0; }));
    const auto named = [&] { return std::count(fault.causes.begin(), fault.causes.end(), push->cause.load()) > 0; };
    EXPECT_TRUE(fault.causes.empty() || soon(named)) << sentence(push->cause.load());
    fault.end(arm, *push);
    if (!fault.heals) {
      std::this_thread::sleep_for(100ms);
      EXPECT_EQ(arm.force(), 0) << "until it is reset";
      push->reset = true;
    }
    ASSERT_TRUE(soon([&] { return arm.force() > 0; }));
    EXPECT_LT(arm.force(), 0.5 * kForce) << "from zero";
  }
  EXPECT_TRUE(pushes());
  EXPECT_TRUE(pen->stop());
  EXPECT_TRUE(soon([&] { return arm.force() == 0; })) << "with the driver";
}

/// Pulled out at all moments of a frame, and of the ramp.
TYPED_TEST(ArmFault, PulledOutFiveTimes) {
  TypeParam arm;
  const auto pen = open_pen(arm.kind());
  pen->set_step(std::make_shared<Pushing>());
  for (int k = 0; k < 5; ++k) {
    SCOPED_TRACE(k);
    ASSERT_TRUE(soon([&] { return arm.force() > 0.02; }));
    std::this_thread::sleep_for(std::chrono::microseconds(200 * k + 30'000 * (k % 3)));
    arm.plug(false);
    EXPECT_TRUE(soon([&] { return pen->status().state != LinkState::Connected && arm.force() == 0; }));
    arm.plug(true);
  }
  EXPECT_TRUE(soon([&] { return arm.force() > 0.95 * kForce; }));
  EXPECT_GE(pen->status().counts.connections, 6U);
}

}  // namespace
}  // namespace riffler::pen::arm_faults_test
