// Haply's arms with everything between: driver, WebSocket and service, with the faults that a service may have.
#include "pen/haply/haply_devices.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <functional>
#include <string>
#include <thread>

#include "pen/haply/inverse_service.hpp"
#include "riffler/pen/registry.hpp"

namespace riffler::pen::haply_devices_test {
namespace {

using namespace std::chrono_literals;
using test::InverseService;
using State = InverseService::State;

class Haply : public ::testing::Test {
 protected:
  void SetUp() override { use(service.port()); }
  void TearDown() override { ::unsetenv("RIFFLER_HAPLY_PORT"); }
  static void use(unsigned port) { ::setenv("RIFFLER_HAPLY_PORT", std::to_string(port).c_str(), 1); }

  /// Pushes until `done`, or for ten seconds; then whether it is.
  bool push_until(Pen& pen, const std::function<bool()>& done, double newtons = 1) {
    for (const auto end = std::chrono::steady_clock::now() + 10s; std::chrono::steady_clock::now() < end;) {
      answer = pen.push({{0, 0, newtons}, {}});
      if (done()) return true;
      std::this_thread::sleep_for(1ms);
    }
    return done();
  }
  /// Pushes for a while. Returns how often the service had no force, in ms.
  int push_for(Pen& pen, std::chrono::milliseconds time) {
    int without = 0;
    for (const auto end = std::chrono::steady_clock::now() + time; std::chrono::steady_clock::now() < end;) {
      answer = pen.push({{0, 0, 1}, {}});
      without += service.force() == 0;
      std::this_thread::sleep_for(1ms);
    }
    return without;
  }
  bool pushes(Pen& pen) {
    return push_until(pen, [&] { return service.force() > 0.95; });
  }
  static std::string problem_of(const std::function<void()>& call) {
    try {
      call();
    } catch (const OpenError& error) {
      return std::string(problem_text(error.problem())) + ": " + error.what();
    }
    return "none";
  }

  InverseService service;
  PushAnswer answer;
};

TEST_F(Haply, OpensReadsAndPushes) {
  const auto pen = open_pen("haply");
  EXPECT_EQ(pen->kind(), "haply");
  EXPECT_TRUE(pushes(*pen));
  EXPECT_EQ(answer.reason, NotPushed::None);
  EXPECT_EQ(pen->push({{0, 0, 1}, {0, 5, 0}}).reason, NotPushed::NoMotors) << "no motors for torque";
  const PenSample sample = pen->newest();
  EXPECT_LT(glm::length(sample.pose.tip - Vec3(0, -120, 150)), 1e-6);
  EXPECT_LT(glm::length(sample.pose.axis - Vec3(0, -1, 0)), 1e-6);
  EXPECT_TRUE(sample.homed && sample.powered);
  EXPECT_EQ(pen->status().counts.malformed, 0U);
  EXPECT_TRUE(pen->stop());
  // The command is sent; the service's thread reads it later.
  for (int k = 0; k < 1000 && service.force() != 0; ++k) std::this_thread::sleep_for(1ms);
  EXPECT_EQ(service.force(), 0);
  EXPECT_EQ(service.with([](State& s) { return s.wrong_commands; }), 0);
}

/// One command a millisecond, although the service answers at once.
TEST_F(Haply, CommandsAreSentAThousandTimesASecondAtMost) {
  const auto pen = open_pen("haply");
  std::this_thread::sleep_for(50ms);
  const int before = service.with([](State& s) { return s.commands; });
  const auto start = std::chrono::steady_clock::now();
  std::this_thread::sleep_for(500ms);
  const int sent = service.with([](State& s) { return s.commands; }) - before;
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  EXPECT_LT(sent, 1020 * seconds);
  EXPECT_GT(sent, 100 * seconds);
}

TEST_F(Haply, TheForceEndsWithTheRequests) {
  const auto pen = open_pen("haply");
  ASSERT_TRUE(pushes(*pen));
  std::this_thread::sleep_for(100ms);
  EXPECT_EQ(service.force(), 0);
  EXPECT_EQ(pen->status().state, LinkState::Connected);
}

TEST_F(Haply, ServicesBefore35GetTheOlderFormOfAForce) {
  service.with([](State& s) { s.version = "3.1.1.0"; });
  const auto pen = open_pen("haply");
  EXPECT_TRUE(pushes(*pen));
  EXPECT_EQ(service.with([](State& s) { return s.wrong_commands; }), 0);
}

TEST_F(Haply, TwoArmsAreTwoDevicesEachWithItsGrip) {
  service.with([](State& s) {
    s.arms.push_back({});
    s.arms[1].id = "04BA", s.arms[1].type = "minverse", s.arms[1].position = {0.05, 0, 0};
    s.grips.push_back({});
    s.grips[1].id = "7", s.grips[1].orientation = {0, 0, 0, 1};
    s.grips[1].buttons = R"("buttons":{"a":true,"b":false,"c":true})";
  });
  std::vector<FoundDevice> found = find_haply();
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].path, "haply:049D");
  EXPECT_EQ(found[1].path, "haply:04BA");
  EXPECT_EQ(found[1].name, "minverse");
  EXPECT_NE(found[1].about.find("grip 7"), std::string::npos) << found[1].about;
  const auto first = open_pen("haply:049D"), second = open_pen("haply:04BA");
  ASSERT_TRUE(push_until(*second, [&] { return service.force(1) > 0.95; }));
  EXPECT_EQ(service.force(0), 0) << "the other arm";
  EXPECT_NEAR(second->newest().pose.tip.x, 50, 1e-9);
  EXPECT_EQ(second->newest().buttons, 5U);
  EXPECT_EQ(first->newest().buttons, 0U);
  EXPECT_LT(glm::length(second->newest().pose.axis - Vec3(0, 1, 0)), 1e-9);
  EXPECT_EQ(problem_of([] { open_pen("haply:FFFF"); }),
            "unplugged: the Inverse Service has no arm FFFF; is it plugged in?");
}

TEST_F(Haply, AnArmThatAnotherProgramUsesIsPassedOver) {
  service.with([](State& s) {
    s.arms.push_back({});
    s.arms[1].id = "04BA";
    s.arms[0].in_use = true;
  });
  EXPECT_EQ(find_haply()[0].problem, OpenProblem::Busy);
  EXPECT_NE(problem_of([] { open_pen("haply:049D"); }).find("busy: another program uses the arm"), std::string::npos);
  const auto pen = open_pen("haply");
  EXPECT_TRUE(push_until(*pen, [&] { return service.force(1) > 0.95; }));
}

TEST_F(Haply, LostAnswersAndJitterDoNotEndTheConnection) {
  const auto pen = open_pen("haply");
  ASSERT_TRUE(pushes(*pen));
  service.with([](State& s) { s.lose_every = 20, s.delay = 2ms, s.late_every = 7; });
  EXPECT_LT(push_for(*pen, 1500ms), 1000) << "a lost answer is missed for 10 ms, and the command repeated";
  EXPECT_EQ(pen->status().counts.connections, 1U);
  EXPECT_GT(pen->status().counts.timeouts, 10U);
  service.with([](State& s) { s.lose_every = 0, s.delay = 0ms; });
  EXPECT_TRUE(pushes(*pen));
}

TEST_F(Haply, StaleAnswersRemoveTheForce) {
  const auto pen = open_pen("haply");
  ASSERT_TRUE(pushes(*pen));
  service.with([](State& s) { s.delay = 60ms; });
  EXPECT_TRUE(push_until(*pen, [&] { return pen->force_state() == haptics::ForceState::Tripped; }));
  EXPECT_TRUE(pen->cause() == haptics::Cause::Stale || pen->cause() == haptics::Cause::LateTick);
  EXPECT_EQ(answer.reason, NotPushed::Tripped);
  EXPECT_TRUE(push_until(*pen, [&] { return pen->status().wrench == Wrench{}; })) << "the driver's next command";
  service.with([](State& s) { s.delay = 0ms; });
  EXPECT_TRUE(pushes(*pen)) << "this heals by itself, with a ramp";
}

TEST_F(Haply, AServiceThatRestartsIsFoundAgainAndTheForceRamps) {
  const auto pen = open_pen("haply");
  ASSERT_TRUE(pushes(*pen));
  service.stop();
  EXPECT_TRUE(push_until(*pen, [&] { return pen->status().state != LinkState::Connected; }));
  EXPECT_EQ(answer.reason, NotPushed::NotConnected);
  EXPECT_EQ(pen->status().wrench, Wrench{});
  EXPECT_TRUE(push_until(*pen, [&] { return pen->status().counts.attempts > 0; }));
  service.with([](State& s) { s.version = "3.1.0.0", s.arms[0].force = {}; });  // it was replaced by an older one
  service.start();
  ASSERT_TRUE(push_until(*pen, [&] { return service.force() > 0; }));
  EXPECT_LT(service.force(), 0.5) << "from zero";
  EXPECT_TRUE(pushes(*pen));
  EXPECT_EQ(pen->status().counts.connections, 2U);
}

TEST_F(Haply, AnArmThatIsPulledOutOrPoweredOffGetsNoForce) {
  const auto pen = open_pen("haply");
  ASSERT_TRUE(pushes(*pen));
  service.with([](State& s) { s.arms[0].power_supply = false; });
  EXPECT_TRUE(push_until(*pen, [&] { return answer.reason == NotPushed::NotPowered && service.force() == 0; }));
  service.with([](State& s) { s.arms[0].power_supply = true, s.arms[0].calibrated = false; });
  EXPECT_TRUE(push_until(*pen, [&] { return answer.reason == NotPushed::NotHomed && service.force() == 0; }));
  service.with([](State& s) { s.arms[0].calibrated = true; });
  pen->reset();
  ASSERT_TRUE(pushes(*pen));
  service.with([](State& s) { s.arms[0].plugged = false; });
  EXPECT_TRUE(push_until(*pen, [&] { return pen->status().counts.silences == 1; }));
  EXPECT_EQ(service.force(), 0);
  EXPECT_TRUE(push_until(*pen, [&] { return pen->problem().find("has no arm 049D") != std::string::npos; }));
  service.with([](State& s) { s.arms[0].plugged = true; });
  EXPECT_TRUE(pushes(*pen));
}

TEST_F(Haply, InvalidMessagesAreNoSignOfLife) {
  const auto pen = open_pen("haply");
  for (const char* text :
       {"{}", "][", "{\"inverse3\":[{\"device_id\":\"049D\",\"state\":{\"cursor_position\":{}}}]}"}) {
    ASSERT_TRUE(pushes(*pen));
    const std::uint32_t silences = pen->status().counts.silences;
    service.with([&](State& s) { s.nonsense = text; });
    EXPECT_TRUE(push_until(*pen, [&] { return pen->status().counts.silences > silences; })) << text;
    EXPECT_EQ(pen->status().wrench, Wrench{});
    service.with([](State& s) { s.nonsense.clear(); });
  }
  EXPECT_GT(pen->status().counts.malformed, 0U);
}

TEST_F(Haply, AJumpOfTheArmRemovesTheForceUntilAReset) {
  const auto pen = open_pen("haply");
  ASSERT_TRUE(pushes(*pen));
  service.with([](State& s) { s.arms[0].position[0] += 0.05; });
  EXPECT_TRUE(push_until(*pen, [&] { return pen->force_state() == haptics::ForceState::Tripped; }));
  EXPECT_EQ(pen->cause(), haptics::Cause::Jump);
  EXPECT_TRUE(push_until(*pen, [&] { return service.force() == 0; }));
  pen->reset();
  EXPECT_TRUE(pushes(*pen));
}

TEST_F(Haply, TheForceNeverExceedsTheLimit) {
  const auto pen = open_pen("haply");
  EXPECT_TRUE(push_until(*pen, [&] { return service.with([](State& s) { return s.most_force; }) >= 4.99; }, 19));
  EXPECT_LE(service.with([](State& s) { return s.most_force; }), 5);
}

TEST_F(Haply, OtherServersAndOtherVersionsAreNamed) {
  const auto text = [&](const std::function<void(State&)>& change) {
    service.with([&](State& s) {
      s = State{};
      change(s);
    });
    return problem_of([] { open_pen("haply"); });
  };
  const std::string at = "127.0.0.1:" + std::to_string(service.port()) + ": ";
  EXPECT_EQ(text([](State& s) { s.version = "4.0.1.0"; }),
            "other protocol version: the Inverse Service has version 4.0; Riffler speaks with 3.1 and later versions "
            "of 3");
  EXPECT_EQ(text([](State& s) { s.project = "a web server"; }),
            "contradicts itself: " + at + "it does not call itself haply-inverse-service");
  EXPECT_EQ(text([](State& s) { s.inventory = "hello"; }),
            "contradicts itself: " + at + "the service's list of devices makes no sense");
  EXPECT_EQ(text([](State& s) { s.arms.clear(); }),
            "not there: the Inverse Service runs, and has no Inverse3; is it plugged in and switched on?");
  ASSERT_EQ(find_haply().size(), 1U);
  EXPECT_FALSE(find_haply()[0].is_there);
}

TEST_F(Haply, TheErrorOfAClosedPortNamesWhatToStart) {
  service.stop();
  const std::vector<FoundDevice> found = find_haply();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_FALSE(found[0].is_there);
  EXPECT_EQ(found[0].problem, OpenProblem::NotRunning);
  EXPECT_NE(found[0].text.find("start Haply Hub"), std::string::npos) << found[0].text;
  EXPECT_NE(problem_of([] { open_pen("haply"); }).find("not running: 127.0.0.1:"), std::string::npos);
  for (const char* port : {"0", "70000", "ten", "10001 "}) {
    ::setenv("RIFFLER_HAPLY_PORT", port, 1);
    EXPECT_EQ(problem_of([] { open_pen("haply"); }),
              std::string("system error: RIFFLER_HAPLY_PORT must be a port, 1 to 65535, not \"") + port + "\"");
  }
}

TEST_F(Haply, IsListedAmongTheDevicesOrTheMissingOnes) {
  const auto has = [](const std::vector<FoundDevice>& all, const char* path) {
    for (const FoundDevice& found : all)
      if (found.path == path) return std::string(found.family->kind);
    return std::string("none");
  };
  EXPECT_EQ(has(find_devices(), "haply:049D"), "haply");
  EXPECT_EQ(has(find_unavailable(), "haply"), "none");
  EXPECT_EQ(service.with([](State& s) { return s.commands; }), 0) << "a search commands nothing";
  service.stop();
  EXPECT_EQ(has(find_devices(), "haply:049D"), "none");
  EXPECT_EQ(has(find_unavailable(), "haply"), "haply");
}

}  // namespace
}  // namespace riffler::pen::haply_devices_test
