// A device and a clock that play a script: no hardware, no waiting, the same every time.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <vector>

#include "device/firmware/pen_firmware.h"
#include "pen/driver_loop.hpp"
#include "pen/hid/hid_transport.hpp"

namespace riffler::test {

using Report = std::vector<std::uint8_t>;

class VirtualClock final : public pen::Clock {
 public:
  double now() noexcept override { return time; }
  void wait(double seconds) noexcept override { time += seconds; }
  double time = 100;
};

/// What outlives the handle: the device at the end of the cable.
struct FakeDevice {
  struct Event {
    double time;
    Report bytes;
  };
  VirtualClock* clock = nullptr;
  std::deque<Event> events;
  double gone = 1e300;  // when it is unplugged
  bool deaf = false;    // writes fail
  std::vector<Report> written;
  std::vector<std::uint8_t> hid;  // its report descriptor
  std::function<int(std::span<std::uint8_t>)> feature = [](std::span<std::uint8_t>) { return -1; };
  std::function<void(const Report&)> on_write = [](const Report&) {};
  /// Called before each read with the time up to which the reader waits: may add events.
  std::function<void(double)> on_read = [](double) {};
  int open = 0;

  void send(double time, Report bytes) { events.push_back({time, std::move(bytes)}); }
};

class FakeTransport final : public pen::HidTransport {
 public:
  explicit FakeTransport(FakeDevice& device) : device_(device) { ++device_.open; }
  ~FakeTransport() override { --device_.open; }

  int read(std::span<std::uint8_t> bytes, double seconds) noexcept override {
    double& now = device_.clock->time;
    device_.on_read(now + seconds);
    if (device_.events.empty() || device_.events.front().time > now + seconds) {
      now += seconds;
      return now >= device_.gone ? -1 : 0;
    }
    const FakeDevice::Event event = device_.events.front();
    if (event.time >= device_.gone) return now = std::max(now, device_.gone), -1;
    device_.events.pop_front();
    now = std::max(now, event.time);
    std::copy(event.bytes.begin(), event.bytes.end(), bytes.begin());
    return static_cast<int>(event.bytes.size());
  }

  bool write(std::span<const std::uint8_t> bytes) noexcept override {
    if (device_.deaf || device_.clock->time >= device_.gone) return false;
    device_.written.emplace_back(bytes.begin(), bytes.end());
    device_.on_write(device_.written.back());
    return true;
  }

  int get_feature(std::span<std::uint8_t> bytes) noexcept override { return device_.feature(bytes); }
  std::span<const std::uint8_t> descriptor() const noexcept override { return device_.hid; }

 private:
  FakeDevice& device_;
};

/// Answers at once, and remembers when it was asked.
class FakeConnector final : public pen::Connector {
 public:
  explicit FakeConnector(FakeDevice& device) : device_(device) {}
  void begin() noexcept override { asked.push_back(device_.clock->time); }
  Answer poll(std::unique_ptr<pen::Transport>& transport, pen::OpenProblem& problem) noexcept override {
    if (!there) return problem = pen::OpenProblem::NoFile, Answer::Failed;
    transport = std::make_unique<FakeTransport>(device_);
    return Answer::Opened;
  }
  bool there = true;
  std::vector<double> asked;

 private:
  FakeDevice& device_;
};

/// A Riffler pen: the reference firmware behind the fake cable, a report each millisecond of the virtual clock. Whoever
/// holds it trembles by a count under force.
class FirmwarePen {
 public:
  explicit FirmwarePen(VirtualClock& clock) : time_(clock.time) {
    device.clock = &clock;
    device.hid.assign(riffler_pen_descriptor, riffler_pen_descriptor + riffler_pen_descriptor_size);
    riffler_pen_reference_config(&config);
    power_on();
    device.feature = [this](std::span<std::uint8_t> bytes) {
      const std::size_t n = riffler_pen_feature(&config, bytes[0], bytes.data(), bytes.size());
      return n == 0 ? -1 : static_cast<int>(n);
    };
    device.on_write = [this](const Report& bytes) { riffler_pen_receive(&firmware, bytes.data(), bytes.size()); };
    device.on_read = [this](double until) { run(until); };
  }

  void power_on() {
    riffler_pen_init(&firmware, &config);
    sensors = {};
    sensors.ready = 1;
    for (auto& t : sensors.temperature_dc) t = 250;
  }

  /// Steps whole milliseconds, and queues what they send. At most one second at once, and only while it is plugged in.
  void run(double until) {
    for (int k = 0; k < 1000 && time_ + 1e-3 <= until + 1e-9 && time_ < device.gone; ++k) {
      time_ += 1e-3;
      if (pushes())
        for (std::int32_t& counter : sensors.counters) counter += trembled_ ? -1 : 1;
      trembled_ = pushes() && !trembled_;
      on_step();
      drive = riffler_pen_step(&firmware, &sensors, 1000);
      for (std::size_t j = 0; j < RIFFLER_PEN_JOINTS; ++j) sensors.current_ma[j] = drive.current_ma[j];
      const riffler_pen_input report = riffler_pen_report(&firmware);
      Report bytes(RIFFLER_PEN_INPUT_SIZE);
      riffler_pen_encode_input(&report, bytes.data());
      if (events_late == 0) device.send(time_, std::move(bytes));
    }
  }

  bool pushes() const {
    return std::any_of(drive.current_ma, drive.current_ma + RIFFLER_PEN_JOINTS, [](int c) { return c != 0; });
  }

  FakeDevice device;
  riffler_pen_config config{};
  riffler_pen_firmware firmware{};
  riffler_pen_sensors sensors{};
  riffler_pen_drive drive{};
  int events_late = 0;  // not 0: it runs, and its reports get lost
  std::function<void()> on_step = [] {};

 private:
  double time_;
  bool trembled_ = false;
};

/// What has passed a gate that is wide open.
inline haptics::SafeWrench let_through(const Wrench& wrench) {
  haptics::Safety safety{{.ramp = 1e-4, .rest = 0, .wrench_ceiling = {1e9, 1e9}}};
  safety.switch_on();
  safety.observe({.dt = 1e-3, .homed = true, .dead_man = true});
  return safety.release(wrench);
}

/// A step that always asks for the same, and counts. Its gate opens at once, from the second step on.
class ConstantPush final : public pen::PenStep {
 public:
  ConstantPush() { safety_.switch_on(); }
  haptics::SafeWrench step(const pen::PenSample& sample, double now, double dt) noexcept override {
    ++steps, last = sample, last_now = now, last_dt = dt;
    safety_.observe({.dt = 1e-3, .homed = true, .dead_man = holds});
    return safety_.release(wrench);
  }
  bool holds = true;  // the dead-man switch
  Wrench wrench{};
  int steps = 0;
  pen::PenSample last{};
  double last_now = 0, last_dt = 0;

 private:
  haptics::Safety safety_{{.ramp = 1e-4, .rest = 0}};
};

}  // namespace riffler::test
