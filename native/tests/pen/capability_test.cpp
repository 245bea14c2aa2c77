// What devices say of themselves.
#include "riffler/pen/capability.hpp"

#include <gtest/gtest.h>

#include "pen/arms/wrench_split.hpp"
#include "riffler/pen/arms/motors.hpp"
#include "support/pens.hpp"

namespace riffler::pen::capability_test {
namespace {

DeviceCapability three_motors() {
  DeviceCapability out;
  out.name = "three motors";
  for (std::size_t k = 0; k < 3; ++k) out.coordinates[k] = {Sensing::Position, true, -100, 100, 0.01, 10, 3};
  return out;
}

TEST(Capability, TextNamesWhatTheHandWillNotFeel) {
  EXPECT_EQ(capability_text(pen_capability(load_pen("riffler"))),
            "senses x y z a b c, pushes x y z a b; the hand does not feel: torque about the grip's axis");
  EXPECT_EQ(capability_text(three_motors()),
            "senses x y z, pushes x y z; the hand does not feel: torque about x, torque about y, torque about z");
  DeviceCapability puck;
  for (CoordinateCapability& c : puck.coordinates) c.sensing = Sensing::Rate;
  EXPECT_EQ(capability_text(puck), "senses x y z a b c, pushes nothing");
  EXPECT_FALSE(puck.has_force());
}

TEST(Capability, PushesOnlyWhatTheArmsCanBear) {
  stress::Random random(61);
  const DeviceCapability pen = pen_capability(load_pen("riffler")), three = three_motors();
  for (int k = 0; k < 1000; ++k) {
    const Vec3 axis = random.direction();
    const Wrench wrench{5.0 * random.direction(), 50.0 * random.direction()};
    const Wrench missing = wrench - renderable(pushed(pen, axis), wrench);
    EXPECT_LT(glm::length(missing.force), 1e-14);
    EXPECT_LT(glm::distance(missing.torque, split_wrench(wrench, 30.0 * axis).missing), 1e-13);
    EXPECT_EQ(renderable(pushed(three, axis), wrench), (Wrench{wrench.force, Vec3(0)}));
  }
}

TEST(Capability, PensStrengthIsWhatItsMotorsHaveAtHome) {
  PenGeometry geometry = load_pen("riffler");
  geometry.force = geometry.torque = 1e6;  // so that the motors are what ends it
  const DeviceCapability capability = pen_capability(geometry);
  const PenKinematics pen(geometry);
  const PenPosture home = pen.posture(pen.home_angles());
  // At home half of a force along z is on each fore arm: 90 N·mm of each N, through 1 : 6, of 90 N·mm.
  EXPECT_NEAR(capability[Coordinate::Z].peak, 6, 1e-3);
  EXPECT_NEAR(capability[Coordinate::Z].continuous, 2, 1e-3);
  for (int k = 0; k < 3; ++k) {
    Wrench wrench;
    wrench.force[k] = capability.coordinates[static_cast<std::size_t>(k)].peak;
    const auto scale = [&](double times) {
      return motor_currents(geometry,
                            motor_torques(geometry, pen_effort(pen, home, times * wrench, home.pose.tip).torques))
          .scale;
    };
    EXPECT_EQ(scale(0.999), 1);
    EXPECT_NEAR(scale(2), 0.5, 1e-9);
  }
  EXPECT_EQ(capability[Coordinate::C].peak, 0);
  EXPECT_FALSE(capability[Coordinate::C].pushes);
}

TEST(Capability, PensLimitsAndResolutionsAreItsOwn) {
  const PenGeometry geometry = load_pen("riffler");
  const DeviceCapability capability = pen_capability(geometry);
  EXPECT_EQ(capability.turns, TurnAxes::Grip);
  EXPECT_EQ(capability[Coordinate::Y].low, -110);
  EXPECT_LE(capability[Coordinate::X].peak, geometry.force);
  EXPECT_LE(capability[Coordinate::A].peak, geometry.torque);
  // Half of what the end of a 180 mm fore arm moves in one count of 48000.
  EXPECT_NEAR(capability[Coordinate::Z].resolution, 90 * 6.283185307 / 48000, 1e-6);
  EXPECT_NEAR(capability[Coordinate::C].resolution, 6.283185307 / 800, 1e-9);
}

}  // namespace
}  // namespace riffler::pen::capability_test
