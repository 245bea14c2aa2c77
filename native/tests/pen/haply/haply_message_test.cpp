#include "pen/haply/haply_message.hpp"

#include <gtest/gtest.h>

#include <string>

#include "riffler/geom/vec.hpp"
#include "stress/random.hpp"
#include "support/error_of.hpp"

namespace riffler::pen::haply_message_test {
namespace {

/// In the form of the documentation's first message
/// (https://docs.haply.co/inverseSDK/service/realtime/websocket-protocol), with a grip of each kind.
const std::string kInventory = R"({"session_id":7,"inverse3":[{"device_id":"049D","config":{"type":"inverse3x",
"device_info":{"id":"049D","major_version":7},"gravity_compensation":{"enabled":true,"scaling_factor":1.0}},
"state":{"cursor_position":{"x":0.01,"y":-0.12,"z":0.15},"cursor_velocity":{"x":0.5,"y":0.0,"z":-1e-3},
"angular_position":{"a0":0.0},"body_orientation":{"w":1.0,"x":0.0,"y":0.0,"z":0.0},"control_mode":"idle"},
"status":{"calibrated":true,"in_use":false,"power_supply":true,"ready":false,"started":true}}],
"verse_grip":[{"device_id":"61576","state":{"button":true,"hall":1,"orientation":{"w":0.71655273,"x":0.19647217,
"y":0.6290283,"z":-0.22833252}}}],
"wireless_verse_grip":[{"device_id":"W-1_a","state":{"buttons":{"a":false,"b":true,"c":true},"battery_level":0.7}}]})";

TEST(HaplyMessage, ReadsTheDocumentedForm) {
  HaplyMessage message;
  ASSERT_TRUE(read_haply_message(kInventory, message));
  ASSERT_EQ(message.count, 3U);
  const HaplyEntry& arm = message.entries[0];
  EXPECT_EQ(arm.id, "049D");
  EXPECT_EQ(arm.model, "inverse3x");
  EXPECT_EQ(*arm.position, Vec3(0.01, -0.12, 0.15));
  EXPECT_EQ(*arm.velocity, Vec3(0.5, 0, -1e-3));
  EXPECT_EQ(arm.calibrated, true);
  EXPECT_EQ(arm.in_use, false);
  EXPECT_EQ(arm.ready, false);
  EXPECT_FALSE(arm.orientation);
  const HaplyEntry* const wired = message.nth(true, 0);
  ASSERT_NE(wired, nullptr);
  EXPECT_NEAR((*wired->orientation)[0], 0.71655273, 1e-3);
  EXPECT_EQ(*wired->buttons, 1U);
  const HaplyEntry* const wireless = message.named(true, "W-1_a");
  ASSERT_NE(wireless, nullptr);
  EXPECT_EQ(*wireless->buttons, 6U);
  EXPECT_FALSE(wireless->orientation);
  EXPECT_EQ(message.nth(true, 2), nullptr);
  EXPECT_EQ(message.named(false, "W-1_a"), nullptr);
}

TEST(HaplyMessage, AMessageWithoutDevicesIsOne) {
  HaplyMessage message;
  for (const char* text : {"{}", R"({"inverse3":[]})", R"({"ok":false,"error":"no such device"})"}) {
    EXPECT_TRUE(read_haply_message(text, message)) << text;
    EXPECT_EQ(message.count, 0U);
  }
}

TEST(HaplyMessage, ImpossibleValuesAreRefused) {
  const auto arm = [](const std::string& state) {
    HaplyMessage message;
    return read_haply_message(R"({"inverse3":[{"device_id":"A","state":)" + state + "}]}", message);
  };
  EXPECT_TRUE(arm(R"({"cursor_position":{"x":1,"y":1,"z":1}})"));
  EXPECT_FALSE(arm(R"({"cursor_position":{"x":1,"y":1}})"));
  EXPECT_FALSE(arm(R"({"cursor_position":{"x":2,"y":1,"z":1}})"));
  EXPECT_FALSE(arm(R"({"cursor_position":{"x":"1","y":1,"z":1}})"));
  EXPECT_FALSE(arm(R"({"cursor_position":[1,1,1]})"));
  EXPECT_FALSE(arm(R"({"cursor_position":null})"));
  EXPECT_FALSE(arm(R"({"cursor_velocity":{"x":1e3,"y":0,"z":0}})"));
  EXPECT_FALSE(arm("[]"));
  const auto grip = [](const std::string& q) {
    HaplyMessage message;
    return read_haply_message(R"({"verse_grip":[{"device_id":"A","state":{"orientation":)" + q + "}}]}", message);
  };
  EXPECT_TRUE(grip(R"({"w":0,"x":0.99,"y":0,"z":0})"));
  EXPECT_FALSE(grip(R"({"w":0,"x":0,"y":0,"z":0})"));
  EXPECT_FALSE(grip(R"({"w":1,"x":1,"y":0,"z":0})"));
  HaplyMessage message;
  for (const char* text :
       {"", "[]", "{", R"({"inverse3":{}})", R"({"inverse3":[{"state":{}}]})", R"({"inverse3":[{"device_id":""}]})",
        R"({"inverse3":[{"device_id":"a\"b"}]})", R"({"inverse3":[{"device_id":"a b"}]})",
        R"({"inverse3":[{"device_id":7}]})", R"({"inverse3":[{"device_id":"A","status":{"ready":1}}]})"})
    EXPECT_FALSE(read_haply_message(text, message)) << text;
  EXPECT_FALSE(read_haply_message(R"({"inverse3":[{"device_id":")" + std::string(65, 'A') + "\"}]}", message));
  std::string many = R"({"inverse3":[{"device_id":"A"})";
  for (int k = 0; k < 16; ++k) many += R"(,{"device_id":"A"})";
  EXPECT_FALSE(read_haply_message(many + "]}", message));
}

/// Damaged messages are an answer, and what is accepted is possible.
TEST(HaplyMessage, DamagedMessagesNeverGiveImpossibleValues) {
  stress::Random random(12);
  int accepted = 0;
  for (int k = 0; k < 50'000; ++k) {
    std::string text = kInventory;
    for (int damage = 1 + static_cast<int>(random.uniform() * 3); damage-- > 0;) {
      const auto at = static_cast<std::size_t>(random.uniform() * static_cast<double>(text.size()));
      if (random.uniform() < 0.2)
        text.erase(at, static_cast<std::size_t>(random.uniform() * 20));
      else
        text[at] = static_cast<char>(random.uniform() * 256);
    }
    HaplyMessage message;
    if (!read_haply_message(text, message)) continue;
    ++accepted;
    for (const HaplyEntry& entry : message.all()) {
      EXPECT_FALSE(entry.id.empty());
      if (entry.position) {
        EXPECT_LE(glm::length(*entry.position), 2);
      }
      if (entry.velocity) {
        EXPECT_LE(glm::length(*entry.velocity), 100);
      }
      if (entry.orientation) {
        const auto [w, x, y, z] = *entry.orientation;
        EXPECT_NEAR(w * w + x * x + y * y + z * z, 1, 1e-12);
      }
    }
  }
  EXPECT_GT(accepted, 5'000);
}

TEST(HaplyMessage, ForcesAreWrittenInTheFormOfTheVersion) {
  std::array<std::uint8_t, kLongestHaplyCommand> bytes{};
  const auto text = [&](const Vec3& force, const HaplyVersion& version, const std::string& id = "049D") {
    return std::string(bytes.begin(),
                       bytes.begin() + static_cast<std::ptrdiff_t>(write_haply_force(id, force, version, bytes)));
  };
  EXPECT_EQ(text({0, -0.25, 1.5}, {3, 5}), R"({"inverse3":[{"device_id":"049D","commands":{"set_cursor_force":)"
                                           R"({"vector":{"x":0.0000,"y":-0.2500,"z":1.5000}}}}]})");
  EXPECT_EQ(text({0, -0.25, 1.5}, {3, 1}), R"({"inverse3":[{"device_id":"049D","commands":{"set_cursor_force":)"
                                           R"({"values":{"x":0.0000,"y":-0.2500,"z":1.5000}}}}]})");
  const std::string longest = text(Vec3(-1e300), {3, 5}, std::string(kLongestHaplyName, 'A'));
  EXPECT_LE(longest.size(), kLongestHaplyCommand);
  HaplyMessage message;
  EXPECT_TRUE(read_haply_message(longest, message));
}

TEST(HaplyMessage, TheVersionIsThatOfAnInverseService) {
  const HaplyVersion version =
      read_haply_version(R"({"git_tag":"3.5.0","project_name":"haply-inverse-service","project_version":"3.12.4.0"})");
  EXPECT_EQ(version.major, 3);
  EXPECT_EQ(version.minor, 12);
  using test::error_of;
  EXPECT_EQ(error_of([] { read_haply_version("<html>"); }), "its version is not JSON");
  EXPECT_EQ(error_of([] { read_haply_version(R"({"version":"1"})"); }),
            "it does not call itself haply-inverse-service");
  for (const char* number : {"", "3", "3.", "x.1", "3,1"})
    EXPECT_EQ(error_of([&] {
                read_haply_version(std::string(R"({"project_name":"haply-inverse-service","project_version":")") +
                                   number + "\"}");
              }),
              "its version is not a number")
        << number;
}

}  // namespace
}  // namespace riffler::pen::haply_message_test
