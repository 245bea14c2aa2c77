// The driver's threads, against a device in memory: start, loss, return, and an end in bounded time.
#include "pen/driver.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <thread>

#include "base/real_time.hpp"
#include "pen/driven_pen.hpp"
#include "pen/simulated/simulated_device.hpp"
#include "riffler/pen/published.hpp"

namespace riffler::pen::driver_test {
namespace {

using namespace std::chrono_literals;

/// Shared by the threads: a report each millisecond while it is plugged in.
struct Plug {
  std::atomic<bool> in{true}, stuck{false};
  std::atomic<int> writes{0}, released{0}, open{0};
};

class PlugTransport final : public Transport {
 public:
  explicit PlugTransport(std::shared_ptr<Plug> plug) : plug_(std::move(plug)) { ++plug_->open; }
  ~PlugTransport() override { --plug_->open; }
  int read(std::span<std::uint8_t> bytes, double seconds) noexcept override {
    if (seconds == 0) return 0;
    std::this_thread::sleep_for(1ms);
    while (plug_->stuck) std::this_thread::sleep_for(1ms);
    if (!plug_->in) return -1;
    bytes[0] = 1;
    return 1;
  }
  bool write(std::span<const std::uint8_t> bytes) noexcept override {
    ++plug_->writes;
    if (bytes[0] == 0) ++plug_->released;
    return plug_->in;
  }

 private:
  std::shared_ptr<Plug> plug_;
};

/// One byte in each direction: 1 pushes, 0 does not.
class ByteModel final : public PenModel {
 public:
  ByteModel() { capability_.coordinates[0].pushes = true; }
  const DeviceCapability& capability() const noexcept override { return capability_; }
  double period() const noexcept override { return 1e-3; }
  void begin(double) noexcept override {}
  Taken take(std::span<const std::uint8_t> bytes, double now) noexcept override {
    sample_.sequence += bytes.size();
    sample_.time = now;
    sample_.homed = sample_.powered = true;
    // All fields tell the same, so that a torn copy shows.
    sample_.pose.tip = Vec3(static_cast<double>(sample_.sequence));
    sample_.buttons = static_cast<std::uint32_t>(sample_.sequence);
    return {static_cast<unsigned>(bytes.size()), 0, 0, 0};
  }
  PenSample sample(double) noexcept override { return sample_; }
  std::size_t push(const haptics::SafeWrench& safe, double, std::span<std::uint8_t> bytes) noexcept override {
    bytes[0] = safe.wrench().force.x != 0;
    return 1;
  }
  std::size_t release(double, std::span<std::uint8_t> bytes) noexcept override {
    bytes[0] = 0;
    return 1;
  }

 private:
  DeviceCapability capability_;
  PenSample sample_{};
};

bool eventually(const std::function<bool()>& what, std::chrono::seconds within = 10s) {
  const auto end = std::chrono::steady_clock::now() + within;
  while (std::chrono::steady_clock::now() < end) {
    if (what()) return true;
    std::this_thread::sleep_for(1ms);
  }
  return what();
}

std::unique_ptr<DrivenPen> pen_on(const std::shared_ptr<Plug>& plug) {
  const auto open = [plug]() -> std::unique_ptr<Transport> {
    if (!plug->in) throw OpenError(OpenProblem::NoFile, "it is not plugged in");
    return std::make_unique<PlugTransport>(plug);
  };
  DriverSettings settings;
  settings.silence = 10;  // a busy machine does not make the device go away
  return std::make_unique<DrivenPen>("test", std::make_shared<ByteModel>(), std::make_unique<PlugTransport>(plug), open,
                                     settings);
}

TEST(Driver, ReadsStepsAndWritesInItsOwnThread) {
  const auto plug = std::make_shared<Plug>();
  const auto pen = pen_on(plug);
  EXPECT_TRUE(eventually([&] { return pen->newest().sequence >= 20; }));
  EXPECT_EQ(pen->status().state, LinkState::Connected);
  EXPECT_LT(pen->age(), 5);
  EXPECT_TRUE(pen->stop());
  EXPECT_EQ(plug->open, 0);
}

TEST(Driver, EveryCopyOfTheSampleIsWhole) {
  const auto plug = std::make_shared<Plug>();
  const auto pen = pen_on(plug);
  std::atomic<int> torn{0};
  std::vector<std::thread> readers;
  for (int t = 0; t < 3; ++t)
    readers.emplace_back([&] {
      for (int k = 0; k < 20000; ++k) {
        const PenSample s = pen->newest();
        if (s.pose.tip.x != static_cast<double>(s.sequence) || s.pose.tip.z != s.pose.tip.x || s.buttons != s.sequence)
          ++torn;
      }
    });
  for (std::thread& reader : readers) reader.join();
  EXPECT_EQ(torn, 0);
}

TEST(Driver, RequestsRealTimeAndReportsTheGrantedPriority) {
  const auto plug = std::make_shared<Plug>();
  const auto pen = pen_on(plug);
  ASSERT_TRUE(eventually([&] { return pen->newest().sequence > 0; }));
  const base::ThreadPriority could = base::probe_real_time();
  // rtkit may take its time.
  EXPECT_TRUE(eventually([&] { return pen->priority().level == could.level; })) << pen->priority().text;
  EXPECT_EQ(pen->priority().by, could.by);
}

TEST(Driver, StaysNormalIfItsClockDoesNotWait) {
  const auto pen = SimulatedDevice::open({}, {}, {}, false);
  EXPECT_TRUE(eventually([&] { return pen->newest().sequence > 100; }));
  EXPECT_EQ(pen->priority().text, "normal: real time was not asked for");
}

TEST(Driver, PushHoldsForAMomentOnly) {
  const auto plug = std::make_shared<Plug>();
  const auto pen = pen_on(plug);
  ASSERT_TRUE(eventually([&] { return pen->newest().sequence > 0; }));
  Wrench wrench;
  wrench.force.x = 1;
  EXPECT_EQ(pen->push(wrench).reason, NotPushed::None);
  EXPECT_TRUE(eventually([&] { return pen->status().wrench.force.x == 1 || plug->writes > plug->released; }));
  std::this_thread::sleep_for(50ms);
  EXPECT_TRUE(eventually([&] { return pen->status().wrench.force.x == 0; }));
}

/// A step each millisecond of a device that is homed, and asked for 1 N along x as long as `asks`.
struct Held {
  void run(int milliseconds) {
    for (int k = 0; k < milliseconds; ++k) {
      now += 1e-3;
      if (asks) push.ask({{1, 0, 0}, {}}, now);
      sample.time = now;
      force = push.step(sample, now, 1e-3).wrench().force.x;
    }
  }
  Held() {
    sample.sequence = 1;
    sample.homed = sample.powered = true;
  }
  HeldPush push;
  PenSample sample{};
  double now = 5, force = 0;
  bool asks = true;
};

TEST(HeldPush, RampsUpAndEndsWithTheRequests) {
  Held held;
  held.run(100);
  EXPECT_GT(held.force, 0.1);
  EXPECT_LT(held.force, 0.25);
  held.run(500);
  EXPECT_EQ(held.force, 1);
  held.asks = false;
  held.run(25);
  EXPECT_EQ(held.force, 0);
  held.asks = true;
  held.run(50);
  EXPECT_LT(held.force, 0.15) << "and ramps again";
}

TEST(HeldPush, AJumpEndsItUntilAReset) {
  Held held;
  held.run(1000);
  held.sample.pose.tip.x += 50;
  held.run(1);
  EXPECT_EQ(held.force, 0);
  EXPECT_EQ(held.push.state(), haptics::ForceState::Tripped);
  EXPECT_EQ(held.push.cause(), haptics::Cause::Jump);
  held.run(3000);
  EXPECT_EQ(held.force, 0);
  held.push.reset();
  held.run(1000);
  EXPECT_EQ(held.force, 1);
}

TEST(HeldPush, NothingPushesWithoutAHome) {
  Held held;
  held.sample.homed = false;
  held.run(1000);
  EXPECT_EQ(held.force, 0);
  held.sample.homed = true;
  held.run(1000);
  EXPECT_EQ(held.force, 1);
}

TEST(HeldPush, AfterAnInterruptionItRampsAgainFromTheHandsPlace) {
  Held held;
  held.run(1000);
  held.sample.pose.tip.x += 50;
  held.push.step(held.sample, held.now, 0);
  EXPECT_EQ(held.push.state(), haptics::ForceState::Ramp);
  held.run(50);
  EXPECT_EQ(held.push.cause(), haptics::Cause::None);
  EXPECT_LT(held.force, 0.15);
}

/// A step that knows when it is called, and by how many.
class WatchedStep final : public PenStep {
 public:
  haptics::SafeWrench step(const PenSample&, double, double dt) noexcept override {
    if (gone) ++late;
    if (calls++ == 0) first_dt = dt;
    if (calls == 2) second_dt = dt;
    if (takes > 0ms) std::this_thread::sleep_for(takes);
    return {};
  }
  std::atomic<bool> gone{false};
  std::atomic<int> calls{0}, late{0};
  std::atomic<double> first_dt{-1}, second_dt{-1};
  std::chrono::milliseconds takes{0};
};

TEST(Driver, AnotherStepBeginsWithoutTheTimeBeforeIt) {
  const auto plug = std::make_shared<Plug>();
  const auto pen = pen_on(plug);
  ASSERT_TRUE(eventually([&] { return pen->newest().sequence > 5; }));
  for (int k = 0; k < 3; ++k) {
    const auto step = std::make_shared<WatchedStep>();
    ASSERT_TRUE(pen->set_step(step));
    ASSERT_TRUE(eventually([&] { return step->calls >= 2; }));
    EXPECT_EQ(step->first_dt, 0);
    EXPECT_GT(step->second_dt, 0);
  }
}

TEST(Driver, WithAnotherStepPushIsRefusedAndWithNoneItPushesAgain) {
  const auto plug = std::make_shared<Plug>();
  const auto pen = pen_on(plug);
  ASSERT_TRUE(eventually([&] { return pen->newest().sequence > 0; }));
  const Wrench wrench{{1, 0, 0}, {}};
  const auto pushes = [&] { return pen->push(wrench).reason == NotPushed::None && pen->status().wrench.force.x > 0; };
  EXPECT_TRUE(eventually(pushes));
  const auto step = std::make_shared<WatchedStep>();
  ASSERT_TRUE(pen->set_step(step));
  EXPECT_EQ(pen->push(wrench).reason, NotPushed::NoMotors);
  EXPECT_EQ(pen->push(wrench).missing, wrench);
  EXPECT_EQ(pen->force_state(), haptics::ForceState::Off);
  EXPECT_TRUE(eventually([&] { return step->calls > 3 && pen->status().wrench == Wrench{}; }));
  ASSERT_TRUE(pen->set_step(nullptr));
  EXPECT_EQ(step.use_count(), 1);
  EXPECT_TRUE(eventually(pushes));
}

/// Steps that take longer than a tick, a device that goes away and comes back, a driver that is stopped: the setter
/// always comes back, and what it replaced is not called any more.
TEST(Driver, AReplacedStepIsNeverCalledAgain) {
  const auto plug = std::make_shared<Plug>();
  auto pen = pen_on(plug);
  std::vector<std::shared_ptr<WatchedStep>> steps;
  for (int k = 0; k < 200; ++k) {
    if (k % 40 == 20) plug->in = false;
    if (k % 40 == 30) plug->in = true;
    auto step = std::make_shared<WatchedStep>();
    if (k % 5 == 0) step->takes = 3ms;
    pen->set_step(step);
    if (!steps.empty()) steps.back()->gone = true;
    steps.push_back(step);
    std::this_thread::sleep_for(2ms);
  }
  EXPECT_TRUE(pen->stop());
  EXPECT_TRUE(pen->set_step(nullptr)) << "after stop there is no call to wait for";
  steps.back()->gone = true;
  pen.reset();
  int calls = 0;
  for (const auto& step : steps) {
    EXPECT_EQ(step->late, 0);
    calls += step->calls;
  }
  EXPECT_GT(calls, 5);
}

TEST(Driver, FindsTheDeviceAgain) {
  const auto plug = std::make_shared<Plug>();
  const auto pen = pen_on(plug);
  ASSERT_TRUE(eventually([&] { return pen->newest().sequence > 0; }));
  plug->in = false;
  EXPECT_TRUE(eventually([&] { return pen->status().state != LinkState::Connected; }));
  EXPECT_TRUE(eventually([&] { return pen->problem() == "it is not plugged in"; }));
  EXPECT_EQ(pen->push({}).reason, NotPushed::NotConnected);
  plug->in = true;
  EXPECT_TRUE(eventually([&] { return pen->status().state == LinkState::Connected; }));
  EXPECT_EQ(pen->status().counts.connections, 2U);
  EXPECT_TRUE(pen->stop());
  EXPECT_EQ(plug->open, 0);
  EXPECT_EQ(pen->status().state, LinkState::Stopped);
}

TEST(Driver, TheLastCommandIsNotToPush) {
  const auto plug = std::make_shared<Plug>();
  const auto pen = pen_on(plug);
  ASSERT_TRUE(eventually([&] { return plug->writes > 10; }));
  const int before = plug->released;
  EXPECT_TRUE(pen->stop());
  EXPECT_GT(plug->released, before);
}

TEST(Driver, ASystemCallThatHangsDoesNotBlockTheEnd) {
  const auto plug = std::make_shared<Plug>();
  auto driver =
      std::make_unique<Driver>(std::make_shared<ByteModel>(), std::make_shared<HeldPush>(),
                               std::make_unique<PlugTransport>(plug), [] { return std::unique_ptr<Transport>(); });
  ASSERT_TRUE(eventually([&] { return plug->writes > 3; }));
  plug->stuck = true;
  std::this_thread::sleep_for(20ms);
  const auto start = std::chrono::steady_clock::now();
  EXPECT_FALSE(driver->stop(0.1));
  EXPECT_LT(std::chrono::steady_clock::now() - start, 5s);
  plug->stuck = false;
  EXPECT_TRUE(driver->stop(10)) << "it ends by itself when the call does";
  driver.reset();
  EXPECT_TRUE(eventually([&] { return plug->open == 0; }));
}

TEST(Published, ReadersNeverSeeAMixture) {
  struct Four {
    std::uint64_t a = 0, b = 0, c = 0, d = 0;
  };
  Published<Four> published;
  std::atomic<bool> done{false};
  std::atomic<int> torn{0}, changes{0};
  std::thread reader([&] {
    std::uint64_t last = 0;
    // Until it has seen the writer at work, which depends on when the system runs both.
    const auto end = std::chrono::steady_clock::now() + 20s;
    while (changes < 100 && std::chrono::steady_clock::now() < end) {
      const Four f = published.get();
      if (f.a != f.b || f.b != f.c || f.c != f.d) ++torn;
      if (f.a != last) ++changes;
      last = f.a;
    }
    done = true;
  });
  std::uint64_t k = 0;
  while (!done) ++k, published.set({k, k, k, k});
  reader.join();
  EXPECT_EQ(torn, 0);
  EXPECT_EQ(changes, 100);
  EXPECT_EQ(published.get().d, k);
}

}  // namespace
}  // namespace riffler::pen::driver_test
