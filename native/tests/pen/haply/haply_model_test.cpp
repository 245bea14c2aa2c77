#include "pen/haply/haply_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

#include "geom/math.hpp"
#include "pen/fake_link.hpp"
#include "riffler/pen/hid/open_error.hpp"
#include "stress/random.hpp"
#include "support/allocations.hpp"

namespace riffler::pen::haply_model_test {
namespace {

using test::let_through;

/// Unit quaternion (w x y z) of a rotation.
std::array<double, 4> rotation(const Vec3& axis, double angle) {
  const Vec3 v = std::sin(angle / 2) * axis;
  return {std::cos(angle / 2), v.x, v.y, v.z};
}

std::array<double, 4> product(const std::array<double, 4>& a, const std::array<double, 4>& b) {
  return {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3], a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
          a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1], a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
}

struct Text {
  Vec3 position{0, -0.12, 0.15}, velocity{0};
  std::array<double, 4> q{1, 0, 0, 0};
  std::string status = R"(,"status":{"calibrated":true,"in_use":false,"power_supply":true,"ready":true})";
  std::string id = "A";
  bool grip = true;

  std::string text() const {
    const auto numbers = [](const char* names, const std::vector<double>& values) {
      std::string out = "{";
      for (std::size_t k = 0; k < values.size(); ++k) {
        char one[48];
        std::snprintf(one, sizeof one, "%s\"%c\":%.17g", k > 0 ? "," : "", names[k], values[k]);
        out += one;
      }
      return out + "}";
    };
    std::string out = R"({"inverse3":[{"device_id":")" + id + R"(","state":{"cursor_position":)" +
                      numbers("xyz", {position.x, position.y, position.z}) + R"(,"cursor_velocity":)" +
                      numbers("xyz", {velocity.x, velocity.y, velocity.z}) + "}" + status + "}]";
    if (grip)
      out += R"(,"verse_grip":[{"device_id":"G","state":{"button":true,"orientation":)" +
             numbers("wxyz", {q[0], q[1], q[2], q[3]}) + "}}]";
    return out + "}";
  }
};

HaplyMessage decoded(const std::string& text) {
  HaplyMessage out;
  EXPECT_TRUE(read_haply_message(text, out)) << text;
  return out;
}

struct Desk {
  explicit Desk(const Text& first = {}) : text(first.text()), model(decoded(text), "A", {3, 5}) { model.begin(0); }
  Taken take(const Text& next, double now) { return take(next.text(), now); }
  Taken take(const std::string& next, double now) {
    return model.take({reinterpret_cast<const std::uint8_t*>(next.data()), next.size()}, now);
  }
  std::string pushed(const Wrench& wrench) {
    const std::size_t n = model.push(let_through(wrench), 0, bytes);
    return {bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(n)};
  }
  std::string text;  // the inventory refers to it
  HaplyModel model;
  std::array<std::uint8_t, kLongestHaplyCommand> bytes{};
};

const std::string kNoForce = R"("vector":{"x":0.0000,"y":0.0000,"z":0.0000})";

TEST(HaplyModel, MetresBecomeMillimetresInTheSameAxes) {
  Desk desk;
  Text at;
  at.position = {0.01, -0.2, 0.03}, at.velocity = {0.1, 0, -0.5};
  EXPECT_EQ(desk.take(at, 1).reports, 1U);
  const PenSample sample = desk.model.sample(1);
  EXPECT_LT(glm::length(sample.pose.tip - Vec3(10, -200, 30)), 1e-12);
  EXPECT_LT(glm::length(sample.velocity - Vec3(100, 0, -500)), 1e-12);
  EXPECT_TRUE(sample.homed);
  EXPECT_TRUE(sample.powered);
  EXPECT_EQ(sample.buttons, 1U);
  EXPECT_EQ(sample.time, 1);
  EXPECT_EQ(sample.sequence, 1U);
}

TEST(HaplyModel, DeclaresWhatItSensesAndPushes) {
  const Desk desk;
  EXPECT_EQ(capability_text(desk.model.capability()).substr(0, 43), "senses x y z a b c, pushes x y z; the hand ");
  EXPECT_EQ(desk.model.capability()[Coordinate::X].peak, HaplyModel::kMostForce);
  Text bare;
  bare.grip = false;
  const Desk without(bare);
  EXPECT_EQ(capability_text(without.model.capability()).substr(0, 31), "senses x y z, pushes x y z; the");
  EXPECT_NE(without.model.about().find("no grip"), std::string::npos) << without.model.about();
}

/// A grip that points down stands upright; one turned about x points away and lies.
TEST(HaplyModel, TheGripsAxisPointsFromTheTipToItsEnd) {
  Desk desk;
  Text at;
  at.q = rotation({1, 0, 0}, -kPi / 2);  // its +y, where it points, is down
  desk.take(at, 1);
  EXPECT_LT(glm::length(desk.model.sample(1).pose.axis - Vec3(0, 0, 1)), 1e-12);
  at.q = rotation({0, 0, 1}, 0);
  desk.take(at, 1);
  EXPECT_LT(glm::length(desk.model.sample(1).pose.axis - Vec3(0, -1, 0)), 1e-12);
}

TEST(HaplyModel, ATurnAboutTheGripsAxisIsSpinAndUnwraps) {
  Desk desk;
  Text at;
  const std::array<double, 4> down = rotation({1, 0, 0}, -kPi / 2);
  at.q = down;
  desk.take(at, 0);
  const double start = desk.model.sample(0).spin;
  for (int k = 1; k <= 1000; ++k) {
    at.q = product(rotation({0, 0, 1}, 0.01 * k), down);  // about the axis, which is up
    if (k % 2 == 0)
      for (double& part : at.q) part = -part;  // the same rotation
    desk.take(at, 1e-3 * k);
  }
  const PenSample sample = desk.model.sample(0);
  EXPECT_NEAR(sample.spin - start, 10, 1e-9);
  EXPECT_LT(glm::length(sample.pose.axis - Vec3(0, 0, 1)), 1e-9);
  EXPECT_LT(glm::length(sample.turning - Vec3(0, 0, 10)), 1e-3);
}

TEST(HaplyModel, TurningIsTheRateOfTheAxisEvenIfTheGripReportsInSteps) {
  Desk desk;
  Text at;
  double most = 0;
  Vec3 mean(0);
  for (int k = 0; k < 1000; ++k) {
    // 3 rad/s about x, seen ten times as seldom as reports arrive.
    at.q = rotation({1, 0, 0}, 3e-3 * 10 * (k / 10));
    desk.take(at, 1e-3 * k);
    most = std::max(most, glm::length(desk.model.sample(0).turning));
    if (k >= 500) mean += desk.model.sample(0).turning / 500.0;
  }
  EXPECT_LT(glm::length(mean - Vec3(3, 0, 0)), 0.05);
  EXPECT_LT(most, 6) << "a step of 30 mrad in a millisecond is not a speed of 30 rad/s";
}

TEST(HaplyModel, PushesTheForceOnlyAndKeepsItsDirectionAtTheLimit) {
  Desk desk;
  desk.take(Text{}, 1);
  EXPECT_NE(desk.pushed({{0.5, -1, 0.25}, {100, 0, 0}}).find(R"("vector":{"x":0.5000,"y":-1.0000,"z":0.2500})"),
            std::string::npos);
  EXPECT_NE(desk.pushed({{30, 0, -40}, {}}).find(R"("vector":{"x":3.0000,"y":0.0000,"z":-4.0000})"), std::string::npos);
  desk.model.release(0, desk.bytes);
  EXPECT_NE(std::string(desk.bytes.begin(), desk.bytes.end()).find(kNoForce), std::string::npos);
}

TEST(HaplyModel, DoesNotPushWhileTheArmIsNotReady) {
  for (const char* flag : {"calibrated", "power_supply", "ready"}) {
    Desk desk;
    Text at;
    const std::size_t where = at.status.find(std::string(flag) + "\":true") + std::string(flag).size() + 2;
    at.status.replace(where, 4, "false");
    desk.take(at, 1);
    EXPECT_NE(desk.pushed({{1, 0, 0}, {}}).find(kNoForce), std::string::npos) << flag;
    at.status.clear();
    desk.take(at, 1);
    EXPECT_NE(desk.pushed({{1, 0, 0}, {}}).find(kNoForce), std::string::npos) << "still, if it does not say so";
    desk.take(Text{}, 1);
    EXPECT_EQ(desk.pushed({{1, 0, 0}, {}}).find(kNoForce), std::string::npos);
  }
  Desk closed;
  closed.take(Text{}, 1);
  closed.model.push({}, 0, closed.bytes);
  EXPECT_NE(std::string(closed.bytes.begin(), closed.bytes.end()).find(kNoForce), std::string::npos);
}

TEST(HaplyModel, MessagesWithoutTheArmAreMalformed) {
  Desk desk;
  Text other;
  other.id = "B";
  EXPECT_EQ(desk.take(other, 1).malformed, 1U);
  for (const char* text : {"", "{}", "null", R"({"inverse3":[{"device_id":"A"}]})", "\xFF"})
    EXPECT_EQ(desk.take(std::string(text), 1).malformed, 1U) << text;
  EXPECT_EQ(desk.model.sample(1).sequence, 0U);
}

TEST(HaplyModel, OtherVersionsBusyAndMissingArmsAreRefused) {
  const auto problem_of = [](const Text& text, const HaplyVersion& version, const char* id) {
    const std::string kept = text.text();
    try {
      HaplyModel(decoded(kept), id, version);
    } catch (const OpenError& error) {
      return error.problem();
    }
    return OpenProblem::None;
  };
  EXPECT_EQ(problem_of({}, {3, 1}, "A"), OpenProblem::None);
  EXPECT_EQ(problem_of({}, {3, 0}, "A"), OpenProblem::OtherVersion);
  EXPECT_EQ(problem_of({}, {4, 0}, "A"), OpenProblem::OtherVersion);
  EXPECT_EQ(problem_of({}, {2, 9}, "A"), OpenProblem::OtherVersion);
  EXPECT_EQ(problem_of({}, {3, 5}, "B"), OpenProblem::Unplugged);
  Text busy;
  busy.status = R"(,"status":{"in_use":true})";
  EXPECT_EQ(problem_of(busy, {3, 5}, "A"), OpenProblem::Busy);
}

TEST(HaplyModel, ReportsAndCommandsAllocateNothing) {
  Desk desk;
  const std::string text = Text{}.text();
  const haptics::SafeWrench safe = let_through({{0.3, -0.2, 1}, {}});
  const long before = test::allocations();
  for (int k = 0; k < 1000; ++k) {
    desk.take(text, 1e-3 * k);
    desk.model.push(safe, 1e-3 * k, desk.bytes);
  }
  EXPECT_EQ(test::allocations(), before);
  EXPECT_EQ(desk.model.sample(1).sequence, 1000U);
}

TEST(HaplyModel, AnyRotationGivesAUnitAxisAndAFiniteRate) {
  stress::Random random(21);
  Desk desk;
  for (int k = 0; k < 20'000; ++k) {
    Text at;
    double square = 0;
    for (double& part : at.q) part = random.uniform(-1, 1), square += part * part;
    if (square < 1e-3) continue;
    for (double& part : at.q) part /= std::sqrt(square);
    ASSERT_EQ(desk.take(at, 1e-3 * k).reports, 1U);
    const PenSample sample = desk.model.sample(0);
    EXPECT_NEAR(glm::length(sample.pose.axis), 1, 1e-12);
    EXPECT_TRUE(std::isfinite(glm::length(sample.turning)) && std::isfinite(sample.spin));
  }
}

}  // namespace
}  // namespace riffler::pen::haply_model_test
