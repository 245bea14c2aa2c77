// What a haptic step does with the pen, all of it: no memory is asked for.
#include <gtest/gtest.h>

#include "pen/arms/count_speed.hpp"
#include "pen/arms/redundancy.hpp"
#include "pen/arms/wrench_split.hpp"
#include "riffler/pen/arms/motors.hpp"
#include "support/allocations.hpp"
#include "support/pens.hpp"

namespace riffler::pen::step_test {
namespace {

TEST(PenStep, AllocatesNothing) {
  const PenKinematics pen(load_pen("riffler"));
  const PenGeometry& geometry = pen.geometry();
  CountSpeed speed(geometry);
  GripDiagnosis diagnosis(pen);
  const EncoderCounts home = pen.counts(pen.home_angles());
  const std::uint64_t before = test::allocations();
  int pushed = 0, fitted = 0, reached = 0, felt = 0;
  for (int k = 0; k < 2000; ++k) {
    EncoderCounts raw = home;
    for (std::int32_t& count : raw) count += k;
    speed.add(raw, 0.001 * k);
    const PenPosture posture = pen.posture(raw);
    fitted += check_grip(pen, posture).fits;
    felt += noticed_counts(pen, posture)[0].few > 0;
    diagnosis.add(posture);
    const PenSpeed moving = pen.speed(posture, speed.rates());
    const Wrench wrench{-0.01 * moving.twist.linear, Vec3(10, 20, 30)};
    JointAngles torques = pen_effort(pen, posture, wrench, posture.pose.tip).torques;
    const JointAngles weight = gravity_torques(geometry, posture.angles);
    for (std::size_t arm = 0; arm < 2; ++arm) torques[arm] += weight[arm];
    MotorTorques motors = motor_torques(geometry, torques);
    const MotorTorques friction = friction_torques(geometry, speed.rates());
    for (std::size_t j = 0; j < kPenChannels; ++j) motors[j] += friction[j];
    pushed += motor_currents(geometry, motors).values[0] != 0;
    reached += pen.inverse(posture.pose).reached();
  }
  EXPECT_EQ(test::allocations() - before, 0U);
  EXPECT_GT(pushed, 1900);
  EXPECT_GT(fitted, 0);
  EXPECT_EQ(felt, fitted);
  EXPECT_GT(reached, 0);
  EXPECT_GT(diagnosis.postures(), 10U);
}

}  // namespace
}  // namespace riffler::pen::step_test
