// The real libhidapi and libudev, as the distribution has them, against devices of umockdev.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/fsuid.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <clocale>
#include <functional>
#include <thread>

#include "allocations.hpp"
#include "device/firmware/pen_firmware.h"
#include "pen/hid/hid_handle.hpp"
#include "riffler/pen/registry.hpp"
#include "support/hid_devices.hpp"
#include "virtual_hid.hpp"

namespace riffler::test {
namespace {

using namespace std::chrono_literals;

/// Counts the allocations of the driver's thread, which is the one that steps.
class CountingStep final : public pen::PenStep {
 public:
  CountingStep() { safety_.switch_on(); }
  haptics::SafeWrench step(const pen::PenSample&, double, double) noexcept override {
    safety_.observe({.dt = 1e-3, .homed = true, .dead_man = true});
    if (++steps_ == 100) before_ = allocations();
    since_ = steps_ > 100 ? allocations() - before_ : 0;
    return safety_.release({{0, 0, 1}, {}});
  }
  std::atomic<long> steps_{0}, since_{-1};

 private:
  haptics::Safety safety_{{}};
  long before_ = 0;
};

VirtualSpec pen_spec() {
  riffler_pen_config config{};
  riffler_pen_reference_config(&config);
  VirtualSpec spec{
      RIFFLER_PEN_VENDOR_ID, RIFFLER_PEN_PRODUCT_ID, "Riffler", RIFFLER_PEN_PRODUCT, "7", pen_descriptor(), {}};
  Bytes identity(RIFFLER_PEN_IDENTITY_SIZE), limits(RIFFLER_PEN_LIMITS_SIZE);
  riffler_pen_encode_identity(&config.identity, identity.data());
  riffler_pen_encode_limits(&config.limits, limits.data());
  spec.features = {{RIFFLER_PEN_IDENTITY_ID, identity}, {RIFFLER_PEN_LIMITS_ID, limits}};
  return spec;
}

VirtualSpec puck_spec(bool joined) {
  return {0x256F,
          static_cast<std::uint16_t>(joined ? 0xC631 : 0xC635),
          "3Dconnexion",
          "SpaceMouse",
          "",
          puck_descriptor(joined),
          {}};
}

VirtualSpec polhem_spec() {
  return {0x16C0, 0x0486, "Teensyduino", "Teensyduino RawHID", "12345", teensy_descriptor(), {}};
}

Bytes pen_report(std::uint16_t sequence) {
  riffler_pen_input report{};
  report.state = RIFFLER_PEN_IDLE;
  report.fault_joint = RIFFLER_PEN_NO_JOINT;
  report.flags = RIFFLER_PEN_FLAG_ARMED;
  report.sequence = sequence;
  report.time_us = 1000U * sequence;
  report.buttons = sequence;
  Bytes bytes(RIFFLER_PEN_INPUT_SIZE);
  riffler_pen_encode_input(&report, bytes.data());
  return bytes;
}

/// The device at the far end: sends reports as fast as the host reads them, and keeps the reports that it gets.
class FarEnd {
 public:
  FarEnd(VirtualBus& bus, const std::string& path) : fd_(dup(bus.device_end(path))) {
    listener_ = std::thread([this] {
      Bytes packet(4096);
      while (!done_) {
        pollfd p{fd_, POLLIN, 0};
        if (poll(&p, 1, 5) <= 0) continue;
        const ssize_t n = recv(fd_, packet.data(), packet.size(), 0);
        if (n <= 0) break;
        told_.emplace_back(packet.begin(), packet.begin() + n);
      }
    });
  }
  FarEnd(const FarEnd&) = delete;
  FarEnd& operator=(const FarEnd&) = delete;
  ~FarEnd() {
    leave();
    close(fd_);
  }

  /// Waits for room.
  void send(const Bytes& report) {
    ASSERT_EQ(::send(fd_, report.data(), report.size(), MSG_NOSIGNAL), static_cast<ssize_t>(report.size()));
  }

  /// All reports that it got.
  const std::vector<Bytes>& leave() {
    done_ = true;
    if (listener_.joinable()) listener_.join();
    return told_;
  }

 private:
  int fd_;
  std::atomic<bool> done_{false};
  std::vector<Bytes> told_;
  std::thread listener_;
};

bool eventually(const std::function<bool()>& what) {
  const auto end = std::chrono::steady_clock::now() + 20s;
  while (std::chrono::steady_clock::now() < end) {
    if (what()) return true;
    std::this_thread::sleep_for(1ms);
  }
  return what();
}

/// A machine that is busy with other things does not make the device go away.
pen::PenOptions patient() {
  pen::PenOptions options;
  options.driver.silence = 10;
  return options;
}

pen::OpenProblem problem_of(const std::function<void()>& call, std::string& text) {
  try {
    call();
  } catch (const pen::OpenError& error) {
    text = error.what();
    return error.problem();
  }
  text.clear();
  return pen::OpenProblem::None;
}

class StockHidapi : public testing::Test {
 protected:
  void SetUp() override {
    bus = std::make_unique<VirtualBus>();
    if (!umockdev_in_mock_environment()) GTEST_SKIP() << "run it with umockdev-wrapper";
  }

  /// Streams 10 000 reports made by `make(1…)` through `pen`, `merged` of them in each packet.
  void stream(pen::Pen& pen, const std::string& path, const std::function<Bytes(int)>& make, int merged = 1) {
    FarEnd far(*bus, path);
    for (int k = 0; k < 10000; k += merged) {
      Bytes packet;
      for (int j = 1; j <= merged; ++j) {
        const Bytes report = make(k + j);
        packet.insert(packet.end(), report.begin(), report.end());
      }
      far.send(packet);
    }
    EXPECT_TRUE(eventually([&] { return pen.status().counts.reports == 10000; }));
    const pen::LinkCounts counts = pen.status().counts;
    EXPECT_EQ(counts.reports, 10000U);
    EXPECT_EQ(counts.lost, 0U);
    EXPECT_EQ(counts.old, 0U);
    EXPECT_EQ(counts.malformed, 0U);
    EXPECT_EQ(counts.connections, 1U);
    EXPECT_EQ(pen.newest().sequence, 10000U);
    std::this_thread::sleep_for(20ms);
    EXPECT_TRUE(pen.stop());
    told = far.leave();
  }

  std::unique_ptr<VirtualBus> bus;
  std::vector<Bytes> told;
};

TEST_F(StockHidapi, ListsPluggedInDevices) {
  bus->plug(pen_spec());
  bus->plug(puck_spec(true));
  const std::vector<pen::HidInfo> found = pen::list_hid();
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].path, "/dev/hidraw0");
  EXPECT_EQ(found[0].id(), "1209:0001");
  EXPECT_EQ(found[0].maker, "Riffler");
  EXPECT_EQ(found[0].name, "Riffler pen");
  EXPECT_EQ(found[0].serial, "7");
  EXPECT_EQ(found[0].interface, 0);
  EXPECT_TRUE(found[0].has_usage(RIFFLER_PEN_USAGE_PAGE, RIFFLER_PEN_USAGE));
  EXPECT_TRUE(found[1].has_usage(1, 8));
}

TEST_F(StockHidapi, NamesBeyondAsciiComeThroughInTheCLocale) {
  ASSERT_STREQ(setlocale(LC_ALL, "C"), "C");
  VirtualSpec spec = puck_spec(false);
  spec.name = "Mäuschen λ";
  bus->plug(spec);
  const std::vector<pen::HidInfo> found = pen::list_hid();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NE(found[0].name.find("Mäuschen λ"), std::string::npos) << found[0].name;
}

TEST_F(StockHidapi, StreamsAPen) {
  const std::string path = bus->plug(pen_spec());
  const auto pen = pen::open_pen("riffler-pen", patient());
  EXPECT_EQ(pen->kind(), "riffler-pen");
  EXPECT_TRUE(pen->capability().has_force());
  // 10 000 of the wrap as well: the numbers begin at 60 000.
  stream(*pen, path, [](int k) { return pen_report(static_cast<std::uint16_t>(60000 + k)); });
  EXPECT_EQ(pen->newest().buttons, static_cast<std::uint16_t>(70000));
  // Every command is whole, and the last one does not push.
  ASSERT_FALSE(told.empty());
  riffler_pen_output last{};
  for (const Bytes& report : told)
    ASSERT_EQ(riffler_pen_decode_output(report.data(), report.size(), &last), RIFFLER_PEN_OK);
  EXPECT_EQ(last.enable, 0);
}

TEST_F(StockHidapi, TheDriversThreadAllocatesNothing) {
  const std::string path = bus->plug(pen_spec());
  const auto step = std::make_shared<CountingStep>();
  const auto pen = pen::open_pen(path, patient());
  pen->set_step(step);
  pen->home();
  FarEnd far(*bus, path);
  for (int k = 1; k <= 1000; ++k) {
    far.send(pen_report(static_cast<std::uint16_t>(k)));
    std::this_thread::sleep_for(1ms);
  }
  EXPECT_TRUE(eventually([&] { return pen->newest().sequence == 1000; }));
  EXPECT_TRUE(pen->stop());
  told = far.leave();
  EXPECT_GT(step->steps_, 500);
  EXPECT_EQ(step->since_, 0);
  riffler_pen_output last{};
  ASSERT_EQ(riffler_pen_decode_output(told[told.size() - 2].data(), told[0].size(), &last), RIFFLER_PEN_OK);
  EXPECT_EQ(last.enable, 1) << "and all of the step was run";
}

TEST_F(StockHidapi, StreamsReportsThatReadsMerge) {
  const std::string path = bus->plug(pen_spec());
  const auto pen = pen::open_pen("riffler-pen", patient());
  stream(*pen, path, [](int k) { return pen_report(static_cast<std::uint16_t>(k)); }, 10);
}

TEST_F(StockHidapi, StreamsAPuckOfSplitReports) {
  const std::string path = bus->plug(puck_spec(false));
  const auto pen = pen::open_pen(path, patient());
  EXPECT_EQ(pen->kind(), "spacemouse");
  EXPECT_EQ(pen->capability().name, "SpaceMouse Compact");
  stream(*pen, path, [](int k) { return puck_report(static_cast<std::uint8_t>(1 + k % 2), {200, 0, 0}); });
  EXPECT_GT(pen->newest().velocity.x, 0);
  EXPECT_GT(pen->newest().pose.tip.x, 0);
  EXPECT_EQ(told.size(), 0U) << "a puck gets no reports";
}

TEST_F(StockHidapi, StreamsAPuckOfJoinedReports) {
  const std::string path = bus->plug(puck_spec(true));
  const auto pen = pen::open_pen(path, patient());
  stream(*pen, path, [](int k) { return puck_report(1, {0, 0, -(k % 350), 0, 0, 0}); });
}

TEST_F(StockHidapi, StreamsAPolhemThatIsAskedForByName) {
  const std::string path = bus->plug(polhem_spec());
  std::string text;
  EXPECT_EQ(problem_of([&] { pen::open_pen(path); }, text), pen::OpenProblem::UnknownDevice);
  EXPECT_NE(text.find("\"polhem\""), std::string::npos) << text;
  const auto pen = pen::open_pen("polhem", patient());
  stream(*pen, path, [](int k) { return polhem_report({k % 100, -(k % 100), 6000, 0, 0, 0, 0}); });
  ASSERT_FALSE(told.empty());
  for (const Bytes& report : told) EXPECT_EQ(report, Bytes(65)) << "not homed: no current";
}

TEST_F(StockHidapi, ShortReportsAreSkipped) {
  const std::string path = bus->plug(pen_spec());
  const auto pen = pen::open_pen(path, patient());
  FarEnd far(*bus, path);
  Bytes cut = pen_report(2);
  cut.resize(30);
  far.send(pen_report(1));
  far.send(cut);
  far.send(pen_report(3));
  EXPECT_TRUE(eventually([&] { return pen->newest().sequence == 3; }));
  EXPECT_EQ(pen->status().counts.malformed, 1U);
  EXPECT_EQ(pen->status().counts.lost, 1U);
}

TEST_F(StockHidapi, APenThatIsPluggedOutAndInContinues) {
  std::string path = bus->plug(pen_spec());
  const auto pen = pen::open_pen(path, patient());
  {
    FarEnd far(*bus, path);
    for (int k = 1; k <= 100; ++k) far.send(pen_report(static_cast<std::uint16_t>(k)));
    ASSERT_TRUE(eventually([&] { return pen->newest().sequence == 100; }));
  }
  bus->unplug(path);
  EXPECT_TRUE(eventually([&] { return pen->status().state != pen::LinkState::Connected; }));
  EXPECT_TRUE(eventually([&] { return pen->problem() == "it is not plugged in"; })) << pen->problem();
  EXPECT_EQ(pen->push({}).reason, pen::NotPushed::NotConnected);
  // The kernel gives it another number.
  path = bus->plug(pen_spec());
  EXPECT_EQ(path, "/dev/hidraw1");
  ASSERT_TRUE(eventually([&] { return pen->status().state == pen::LinkState::Connected; })) << pen->problem();
  FarEnd far(*bus, path);
  for (int k = 1; k <= 100; ++k) far.send(pen_report(static_cast<std::uint16_t>(k)));
  EXPECT_TRUE(eventually([&] { return pen->newest().sequence == 200; }));
  EXPECT_EQ(pen->status().counts.connections, 2U);
}

TEST_F(StockHidapi, PermissionDeniedNamesTheRule) {
  const std::string path = bus->plug(pen_spec());
  chmod(bus->file(path).c_str(), 0600);
  std::string text;
  pen::OpenProblem problem = pen::OpenProblem::None;
  // In this thread only: as a user other than root.
  std::thread([&] {
    if (geteuid() == 0)
      setfsuid(65534);
    else
      chmod(bus->file(path).c_str(), 0);
    problem = problem_of([&] { pen::open_pen("riffler-pen"); }, text);
  }).join();
  EXPECT_EQ(problem, pen::OpenProblem::Permission);
  EXPECT_NE(text.find("/etc/udev/rules.d/60-riffler-1209-0001.rules"), std::string::npos) << text;
  EXPECT_NE(
      text.find(R"(ATTRS{idVendor}=="1209", ATTRS{idProduct}=="0001", ATTRS{product}=="Riffler pen", TAG+="uaccess")"),
      std::string::npos)
      << text;
}

TEST_F(StockHidapi, ADeviceThatAnotherProgramDrivesIsBusy) {
  const std::string path = bus->plug(pen_spec());
  std::string text;
  {
    const int other = open(path.c_str(), O_RDWR | O_NONBLOCK);
    ASSERT_EQ(flock(other, LOCK_EX), 0);
    EXPECT_EQ(problem_of([&] { pen::open_pen(path); }, text), pen::OpenProblem::Busy);
    EXPECT_NE(text.find("in use by another program"), std::string::npos) << text;
    close(other);
  }
  const auto pen = pen::open_pen(path, patient());
  EXPECT_EQ(problem_of([&] { pen::open_pen(path); }, text), pen::OpenProblem::Busy) << "we ourselves";
  ASSERT_EQ(pen::find_devices().size(), 1U);
  EXPECT_EQ(pen::find_devices()[0].problem, pen::OpenProblem::Busy);
  EXPECT_TRUE(pen->stop());
  EXPECT_EQ(problem_of([&] { pen::open_pen(path); }, text), pen::OpenProblem::None);
}

TEST_F(StockHidapi, APenOfAnotherVersionIsNamed) {
  VirtualSpec spec = pen_spec();
  spec.features[RIFFLER_PEN_IDENTITY_ID][RIFFLER_PEN_IDENTITY_MAJOR] = 2;
  spec.descriptor.back() = 0xC1;  // and another descriptor
  const std::string path = bus->plug(spec);
  std::string text;
  EXPECT_EQ(problem_of([&] { pen::open_pen(path); }, text), pen::OpenProblem::OtherVersion);
  EXPECT_NE(text.find("version 2.0"), std::string::npos) << text;
}

TEST_F(StockHidapi, ADescriptorThatDiffersIsNamedByItsByte) {
  VirtualSpec spec = pen_spec();
  spec.descriptor[20] ^= 1;
  bus->plug(spec);
  std::string text;
  EXPECT_EQ(problem_of([&] { pen::open_pen("riffler-pen"); }, text), pen::OpenProblem::WrongDescriptor);
  EXPECT_NE(text.find("at byte 20 "), std::string::npos) << text;
}

TEST_F(StockHidapi, ADeviceWithTheSameNumbersIsNotAPen) {
  VirtualSpec spec = pen_spec();
  spec.name = "Weather station";
  spec.descriptor = teensy_descriptor();
  const std::string path = bus->plug(spec);
  std::string text;
  EXPECT_EQ(problem_of([&] { pen::open_pen(path); }, text), pen::OpenProblem::UnknownDevice);
  EXPECT_NE(text.find("Weather station"), std::string::npos) << text;
  ASSERT_EQ(pen::find_devices().size(), 1U);
  EXPECT_EQ(pen::find_devices()[0].family, nullptr);
  EXPECT_EQ(pen::find_devices()[0].problem, pen::OpenProblem::None);
}

TEST_F(StockHidapi, PathsThatAreNoDevicesAreNamed) {
  std::string text;
  EXPECT_EQ(problem_of([] { pen::open_pen("/dev/hidraw77"); }, text), pen::OpenProblem::NoFile);
  EXPECT_NE(text.find("/dev/hidraw77: no such device"), std::string::npos) << text;
  EXPECT_EQ(problem_of([] { pen::open_pen("/dev/null"); }, text), pen::OpenProblem::NotHid) << text;
  EXPECT_EQ(problem_of([] { pen::open_pen("spacemouse"); }, text), pen::OpenProblem::NoFile);
  EXPECT_EQ(text, "no spacemouse is plugged in");
}

/// The Universal Receiver: an interface without reports, one with a multi-axis collection that sends nothing of a
/// motion, and the puck's.
TEST_F(StockHidapi, TheInterfaceOfAReceiverWithTheReportsIsOpened) {
  VirtualSpec keyboard = puck_spec(true), buttons = puck_spec(true), puck = puck_spec(true);
  keyboard.product = buttons.product = puck.product = 0xC652;
  keyboard.descriptor = {0x05, 0x01, 0x09, 0x06, 0xA1, 0x01, 0xC0};
  buttons.descriptor = {0x05, 0x01, 0x09, 0x08, 0xA1, 0x01, 0x85, 3,    0x05, 0x09, 0x19, 1,   0x29,
                        2,    0x15, 0,    0x25, 1,    0x75, 1,    0x95, 16,   0x81, 0x02, 0xC0};
  bus->plug(keyboard);
  const std::string silent = bus->plug(buttons), sends = bus->plug(puck);
  const auto pen = pen::open_pen("spacemouse", patient());
  {
    FarEnd far(*bus, sends);
    far.send(puck_report(1, {350, 0, 0, 0, 0, 0}));
    EXPECT_TRUE(eventually([&] { return pen->newest().sequence == 1; }));
  }
  EXPECT_GT(pen->newest().velocity.x, 0);
  pen->stop();
  std::string text;
  EXPECT_EQ(problem_of([&] { pen::open_pen(silent); }, text), pen::OpenProblem::WrongDescriptor);
  EXPECT_NE(text.find("the interface that has the reports is " + sends), std::string::npos) << text;
  const std::vector<pen::FoundDevice> found = pen::find_devices();
  ASSERT_EQ(found.size(), 3U);
  for (const pen::FoundDevice& one : found) {
    EXPECT_EQ(one.problem, pen::OpenProblem::None) << one.text;
    EXPECT_EQ(one.family != nullptr, one.path == sends) << one.path;
  }
  bus->unplug(sends);
  EXPECT_EQ(pen::find_devices()[1].problem, pen::OpenProblem::WrongDescriptor) << "alone it is a puck that is wrong";
}

TEST_F(StockHidapi, FindsAndDescribesEveryDevice) {
  bus->plug(pen_spec());
  bus->plug(puck_spec(false));
  bus->plug(polhem_spec());
  VirtualSpec silent = pen_spec();
  silent.features.clear();
  silent.serial = "8";
  bus->plug(silent);
  const std::vector<pen::FoundDevice> found = pen::find_devices();
  ASSERT_EQ(found.size(), 4U);
  EXPECT_EQ(found[0].problem, pen::OpenProblem::None) << found[0].text;
  EXPECT_NE(found[0].about.find("1000 reports a second"), std::string::npos) << found[0].about;
  EXPECT_NE(found[0].capability.find("pushes"), std::string::npos) << found[0].capability;
  EXPECT_EQ(found[1].problem, pen::OpenProblem::None) << found[1].text;
  EXPECT_STREQ(found[2].family->kind, "polhem");
  EXPECT_FALSE(found[2].was_opened);
  EXPECT_EQ(found[3].problem, pen::OpenProblem::NoAnswer) << found[3].text;
}

}  // namespace
}  // namespace riffler::test
