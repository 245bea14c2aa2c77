#include "geom/math.hpp"
#include "nc/machine/machines.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "stress/random.hpp"
#include "support/tilted.hpp"

namespace riffler::nc::machine_test {
namespace {

using test::tilted;

std::unique_ptr<Machine> linuxcnc(const char* name, Options options = {}) {
  options.emplace("rot_point", std::vector<double>{0, 0, 0});
  OptionReader reader(std::move(options), std::string("machine ") + name);
  auto machine = make_machine(name, reader);
  reader.done();
  return machine;
}

/// Where the tip is in part coordinates: the forward kinematics that LinuxCNC's manual prints for xyzac-trt ("5-Axis
/// Kinematics"), with rotary point p and offsets dy, dz.
Vec3 xyzac_forward(const Joints& j, const Vec3& p, double dy, double dz) {
  const double a = j[3] * kDegree, c = j[5] * kDegree, x = j[0] - p.x, y = j[1] - dy - p.y, z = j[2] - dz - p.z;
  return {std::cos(c) * x + std::sin(c) * std::cos(a) * y + std::sin(c) * std::sin(a) * z + std::sin(c) * dy + p.x,
          -std::sin(c) * x + std::cos(c) * std::cos(a) * y + std::cos(c) * std::sin(a) * z + std::cos(c) * dy + p.y,
          -std::sin(a) * y + std::cos(a) * z + dz + p.z};
}

Vec3 xyzbc_forward(const Joints& j, const Vec3& p, double dx, double dz) {
  const double b = j[4] * kDegree, c = j[5] * kDegree, x = j[0] - dx - p.x, y = j[1] - p.y, z = j[2] - dz - p.z;
  return {std::cos(c) * std::cos(b) * x + std::sin(c) * y - std::cos(c) * std::sin(b) * z + std::cos(c) * dx + p.x,
          -std::sin(c) * std::cos(b) * x + std::cos(c) * y + std::sin(c) * std::sin(b) * z - std::sin(c) * dx + p.y,
          std::sin(b) * x + std::cos(b) * z + dz + p.z};
}

Joints somewhere(stress::Random& random, std::size_t tilt) {
  Joints j{};
  for (std::size_t k = 0; k < 3; ++k) j[k] = random.uniform(-200, 200);
  j[tilt] = random.uniform(-120, 120), j[5] = random.uniform(-700, 700);
  return j;
}

TEST(LinuxCncMachines, AgreeWithTheKinematicsOfLinuxCnc) {
  stress::Random random(1);
  for (int n = 0; n < 500; ++n) {
    const Vec3 p(random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-50, 50));
    const Vec3 d(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9));
    const double tool = random.uniform(0, 80);
    const Options options{{"rot_point", std::vector<double>{p.x, p.y, p.z}},
                          {"offset", std::vector<double>{d.x, d.y, d.z}},
                          {"tool_offset", tool}};
    const Joints ac = somewhere(random, 3), bc = somewhere(random, 4);
    const Pose a = linuxcnc("linuxcnc-xyzac", options)->pose(ac), b = linuxcnc("linuxcnc-xyzbc", options)->pose(bc);
    EXPECT_LT(glm::length(a.tip - xyzac_forward(ac, p, d.y, d.z + tool)), 1e-11);
    EXPECT_LT(glm::length(b.tip - xyzbc_forward(bc, p, d.x, d.z + tool)), 1e-11);
    // The axis is the direction in which the tip moves with Z.
    Joints up = ac;
    up[2] += 1;
    EXPECT_LT(glm::length(a.axis - (xyzac_forward(up, p, d.y, d.z) - xyzac_forward(ac, p, d.y, d.z))), 1e-12);
    up = bc, up[2] += 1;
    EXPECT_LT(glm::length(b.axis - (xyzbc_forward(up, p, d.x, d.z) - xyzbc_forward(bc, p, d.x, d.z))), 1e-12);
  }
}

TEST(LinuxCncMachines, IsoTurnsBothAxesTheOtherWay) {
  const auto own = linuxcnc("linuxcnc-xyzac"), iso = linuxcnc("linuxcnc-xyzac", {{"direction", std::string("iso")}});
  const Pose a = own->pose({1, 2, 3, 30, 0, 40}), b = iso->pose({1, 2, 3, -30, 0, -40});
  EXPECT_LT(glm::length(a.tip - b.tip) + glm::length(a.axis - b.axis), 1e-13);
}

/// Every order of axes: two tables, a table and a head, two heads, one of them nutating by 45°.
std::vector<Machine> chains() {
  const Vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1), oblique = glm::normalize(Vec3(0, 1, 1));
  const auto joints = [](const char* name, std::vector<RotaryAxis> rotary) {
    return Machine({name, std::move(rotary), {}, false, {}});
  };
  std::vector<Machine> out;
  out.push_back(joints("ac tables", {{'C', z, {1, 2, 3}}, {'A', x, {1, -7, 40}}}));
  out.push_back(joints("bc tables", {{'C', -z, {0, 0, 0}}, {'B', y, {5, 0, -20}}}));
  out.push_back(joints("nutating table", {{'C', z}, {'B', oblique, {0, 30, 30}}}));
  out.push_back(joints("head and table", {{'C', z, {9, 9, 9}}, {'B', y, {0, 0, 150}, false}}));
  out.push_back(joints("heads", {{'C', z, {0, 0, 180}, false}, {'A', x, {0, 0, 150}, false}}));
  out.push_back(joints("nutating head", {{'C', z, {0, 0, 200}, false}, {'B', oblique, {0, 0, 120}, false}}));
  return out;
}

TEST(Machine, RefusesAPoleThatItsOtherAxisCannotBringTheToolTo) {
  // A table that nutates by 45° reaches the upper half: along C's axis from below is out of reach.
  const Machine machine = std::move(chains()[2]);
  EXPECT_NO_THROW(machine.joints({{1, 2, 3}, {0, 0, 1}}, 0, {}, 1e-6));
  for (const double off : {0.0, 1e-9, 1e-3})
    EXPECT_THROW(machine.joints({{1, 2, 3}, glm::normalize(Vec3(off, 0, -1))}, 0, {}, 1e-6), std::invalid_argument);
}

TEST(Machine, RoundsLimitsInwardsToPrintableValues) {
  MachineDescription description{"m", {{'C', {0, 0, 1}}, {'A', {1, 0, 0}}}, {}, false, {}};
  description.ranges[3] = {-20.12345678, 90.1}, description.ranges[0] = {-1.0 / 3, 2.0 / 3};
  const Machine machine(description);
  EXPECT_EQ(machine.range(3).low, -20.123456);
  EXPECT_EQ(machine.range(3).high, 90.1);
  EXPECT_EQ(machine.range(0).low, -0.33333);
  EXPECT_EQ(machine.range(0).high, 0.66666);
  EXPECT_FALSE(machine.range(5).limited());
}

TEST(Machine, JointsHoldThePoseOnBothBranchesAndKeepNear) {
  for (const Machine& machine : chains()) {
    SCOPED_TRACE(machine.axes());
    stress::Random random(2);
    int held = 0;
    for (int n = 0; n < 2000; ++n) {
      const Pose pose{100.0 * random.direction(), random.direction()};
      const Joints near{0, 0, 0, random.uniform(-900, 900), random.uniform(-900, 900), random.uniform(-900, 900)};
      for (const int branch : {0, 1}) {
        Joints j;
        try {
          j = machine.joints(pose, branch, near, 1e-6);
        } catch (const std::invalid_argument&) {
          continue;
        }
        ++held;
        const Pose is = machine.pose(j);
        EXPECT_LT(glm::length(is.tip - pose.tip), 1e-11);
        EXPECT_LT(glm::length(is.axis - pose.axis), 1e-12);
        for (const char letter : machine.axes().substr(3))
          EXPECT_LE(std::abs(j[joint_index(letter)] - near[joint_index(letter)]), 180 + 1e-9);
      }
    }
    EXPECT_GT(held, 1900) << "a nutating axis by 45 degrees reaches one half of all directions";
  }
}

TEST(Machine, KeepsTheFreeAxisAtThePoleAndItsDigitsNearIt) {
  for (const Machine& machine : chains()) {
    SCOPED_TRACE(machine.axes());
    const Vec3 pole = machine.pole();
    for (const double off : {0.0, 1e-15, 1e-12, 1e-9, 5e-7, 2e-6, 1e-4}) {
      const Vec3 axis = glm::normalize((pole.z > 0 ? pole : -pole) + off * Vec3(0.6, 0.8, 0));
      const Joints near{0, 0, 0, 0, 0, 123};
      const Joints j = machine.joints({{1, 2, 3}, axis}, 0, near, 1e-6);
      const Pose is = machine.pose(j);
      EXPECT_LT(glm::length(is.axis - axis), off < 1e-6 ? 1e-6 : 1e-14) << off;
      EXPECT_LT(glm::length(is.tip - Vec3(1, 2, 3)), 1e-11);
      if (off < 1e-6) {
        EXPECT_EQ(j[5], 123);
      }
    }
  }
}

TEST(Machine, RefusesInvalidMachines) {
  const RotaryAxis a{'A', {1, 0, 0}}, b{'B', {0, 1, 0}}, c{'C', {0, 0, 1}};
  const auto machine = [](std::vector<RotaryAxis> rotary, AxisRange range = {}) {
    MachineDescription d{"m", std::move(rotary), {}, true, {}};
    d.ranges[3] = range;
    return Machine(d);
  };
  EXPECT_NO_THROW(machine({c, a}));
  EXPECT_THROW(machine({a, a}), std::invalid_argument);
  EXPECT_THROW(machine({a, b, c}), std::invalid_argument);
  EXPECT_THROW(machine({RotaryAxis{'C', {1, 0, 0}}, c}), std::invalid_argument);
  EXPECT_THROW(machine({RotaryAxis{'X', {1, 0, 0}}, c}), std::invalid_argument);
  EXPECT_THROW(machine({RotaryAxis{'A', {0, 0, 1}}, c}), std::invalid_argument) << "parallel";
  EXPECT_THROW(machine({RotaryAxis{'A', {2, 0, 0}}, c}), std::invalid_argument);
  EXPECT_THROW(machine({RotaryAxis{'C', {0, 0, 1}, {}, false}, a}), std::invalid_argument) << "a head before a table";
  EXPECT_THROW(machine({c, a}, {10, -10}), std::invalid_argument);
  EXPECT_THROW(machine({c, a}, {-10, 10, 0}), std::invalid_argument);
}

TEST(Machine, OfOneRotaryAxisHoldsWhatLiesInItsPlane) {
  const Machine a({"4-axis", {{'A', {1, 0, 0}, {0, 0, -50}}}, {}, false, {}});
  EXPECT_EQ(a.branches(), 1);
  EXPECT_EQ(a.pole(), Vec3(0));
  for (const double tilt : {-170.0, -20.0, 0.0, 1e-9, 90.0}) {
    const Pose pose{{1, 2, 3}, tilted(tilt, 90)};
    const Joints j = a.joints(pose, 0, {0, 0, 0, 720, 0, 0}, 1e-6);
    EXPECT_LT(glm::length(a.pose(j).axis - pose.axis) + glm::length(a.pose(j).tip - pose.tip), 1e-12);
    EXPECT_LE(std::abs(j[3] - 720), 180);
  }
  EXPECT_THROW(a.joints({{0, 0, 0}, tilted(20, 80)}, 0, {}, 1e-6), std::invalid_argument);
  const Machine c({"rotary table", {{'C', {0, 0, 1}}}, {}, false, {}});
  EXPECT_EQ(c.joints({{1, 2, 3}, {0, 0, 1}}, 0, {0, 0, 0, 0, 0, 77}, 1e-6)[5], 77) << "C is free";
  EXPECT_THROW(c.joints({{0, 0, 0}, tilted(1, 0)}, 0, {}, 1e-6), std::invalid_argument);
}

}  // namespace
}  // namespace riffler::nc::machine_test
