#include "riffler/haptics/coupling.hpp"
#include "geom/math.hpp"

#include <gtest/gtest.h>

#include "stress/random.hpp"
#include "support/error_of.hpp"

namespace riffler::haptics::coupling_test {
namespace {

/// Rotation by a rotation vector (Rodrigues).
Mat3 rotation(const Vec3& v) {
  const double angle = glm::length(v);
  if (angle == 0) return Mat3(1);
  const Vec3 u = v / angle;
  Mat3 r;
  for (int k = 0; k < 3; ++k) {
    Vec3 e{0};
    e[k] = 1;
    r[k] = std::cos(angle) * e + std::sin(angle) * glm::cross(u, e) + (1 - std::cos(angle)) * glm::dot(u, e) * u;
  }
  return r;
}

Vec3 some(stress::Random& random, double size) {
  return random.uniform(0, size) * random.direction();
}

/// A body moved by a small displacement about `pivot`.
Pose moved_by(const Pose& p, const Twist& d, const Vec3& pivot) {
  const Mat3 r = rotation(d.angular);
  return {pivot + d.linear + r * (p.tip - pivot), r * p.axis};
}
RigidFrame moved_by(const RigidFrame& p, const Twist& d, const Vec3& pivot) {
  const Mat3 r = rotation(d.angular);
  return {pivot + d.linear + r * (p.point - pivot), r * p.axes};
}
const Vec3& point(const Pose& p) {
  return p.tip;
}
const Vec3& point(const RigidFrame& p) {
  return p.point;
}

CouplingSettings springs_only() {
  CouplingSettings s;
  s.damping = s.turn_damping = 0;
  return s;
}

/// The work of both wrenches over a small motion of both bodies is what the spring loses: central differences.
template <class Body>
void expect_gradient(const Body& device, const Body& tool, stress::Random& random) {
  const CouplingSettings settings = springs_only();
  const CouplingWrenches w = couple(settings, pose_error(device, tool), {}, {});
  const Vec3 pivot = point(device);
  const Twist a{random.direction(), 0.02 * random.direction()}, b{random.direction(), 0.02 * random.direction()};
  const double h = 1e-4;
  const auto energy = [&](double t) {
    return couple(settings, pose_error(moved_by(device, t * a, pivot), moved_by(tool, t * b, pivot)), {}, {}).energy;
  };
  const double lost = -(energy(h) - energy(-h)) / (2 * h);
  EXPECT_NEAR(power(w.on_device, a) + power(w.on_tool, b), lost, 1e-5 * (1 + std::abs(lost)));
}

TEST(Coupling, SpringsAreTheGradientOfTheirEnergyForBodiesOfRevolution) {
  stress::Random random(1);
  for (int n = 0; n < 3000; ++n) {
    const Pose tool{some(random, 100), random.direction()};
    const Pose device{tool.tip + some(random, 12), random.direction()};
    expect_gradient(device, tool, random);
  }
}

TEST(Coupling, SpringsAreTheGradientOfTheirEnergyForBodiesWithAFront) {
  stress::Random random(2);
  for (int n = 0; n < 3000; ++n) {
    const RigidFrame tool{some(random, 100), rotation(some(random, kPi))};
    const RigidFrame device{tool.point + some(random, 12),
                            rotation(random.uniform(1e-3, kPi - 1e-3) * random.direction()) * tool.axes};
    expect_gradient(device, tool, random);
  }
}

TEST(Coupling, WrenchesAreEqualAndOppositeAndDampersOnlyTakeEnergy) {
  stress::Random random(3);
  const CouplingSettings settings;
  for (int n = 0; n < 1000; ++n) {
    const Pose tool{some(random, 1e5), random.direction()}, device{tool.tip + some(random, 20), random.direction()};
    const Twist a{some(random, 500), some(random, 10)}, b{some(random, 500), some(random, 10)};
    const CouplingWrenches with = couple(settings, pose_error(device, tool), a, b);
    const CouplingWrenches without = couple(springs_only(), pose_error(device, tool), a, b);
    EXPECT_EQ(with.on_device, -with.on_tool);
    EXPECT_EQ(with.energy, without.energy);
    EXPECT_LE(power(with.on_device - without.on_device, a) + power(with.on_tool - without.on_tool, b), 1e-9);
  }
}

TEST(Coupling, RotationVectorsAreFoundFromNothingToHalfATurn) {
  stress::Random random(4);
  for (const double angle : {0.0, 1e-12, 1e-8, 1e-3, 0.5, 1.5, 2.0, 3.0, kPi - 1e-3, kPi - 1e-7, kPi - 1e-12, kPi}) {
    for (int n = 0; n < 200; ++n) {
      const Vec3 u = random.direction();
      const Mat3 start = rotation(some(random, kPi));
      const Vec3 found = pose_error(RigidFrame{{}, rotation(angle * u) * start}, RigidFrame{{}, start}).rotation;
      // At half a turn u and −u are one.
      const Vec3 wanted = angle > kPi - 1e-9 && glm::dot(found, u) < 0 ? -angle * u : angle * u;
      EXPECT_LT(glm::length(found - wanted), 2e-9) << angle;
      const Vec3 axis = random.direction(), square = random.square_to(axis);
      const Vec3 other = std::cos(angle) * axis + std::sin(angle) * square;
      const Vec3 turn = pose_error(Pose{{}, other}, Pose{{}, axis}).rotation;
      EXPECT_NEAR(glm::length(turn), angle, 1e-12 + 1e-15 * angle);
      EXPECT_NEAR(glm::dot(turn, axis), 0, 1e-12);
    }
  }
  // What is small is not rounded away.
  const Vec3 tiny = pose_error(Pose{{}, {1e-12, 0, 1}}, Pose{{}, {0, 0, 1}}).rotation;
  EXPECT_NEAR(tiny.y, 1e-12, 1e-24);
}

TEST(Coupling, TorqueHasNoJumpWhereTheTurnChangesSides) {
  const CouplingSettings settings = springs_only();
  const Vec3 u = glm::normalize(Vec3(1, 2, 3));
  const auto torque = [&](double angle) {
    return couple(settings, pose_error(RigidFrame{{}, rotation(angle * u)}, RigidFrame{}), {}, {}).on_tool.torque;
  };
  for (double angle = 0.01; angle < 2 * kPi; angle += 1e-3)
    EXPECT_LT(glm::length(torque(angle + 1e-3) - torque(angle)), 1.001e-3 * settings.turn_stiffness) << angle;
  EXPECT_LT(glm::length(torque(kPi)), 1e-9 * settings.turn_stiffness);
  EXPECT_NEAR(glm::length(torque(1.5)), settings.turn_stiffness * settings.max_turn, 1e-9);
}

TEST(Coupling, OppositeAxesAndEqualPosesGiveNoTorque) {
  const CouplingSettings settings = springs_only();
  for (const Vec3 axis : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, -1, 0), glm::normalize(Vec3(1, 1, 1))}) {
    const auto opposite = couple(settings, pose_error(Pose{{1e5, 0, 0}, axis}, Pose{{1e5, 0, 0}, -axis}), {}, {});
    EXPECT_LT(glm::length(opposite.on_device.torque), 1e-9);
    EXPECT_EQ(opposite.on_device.force, Vec3(0));
    const auto same = couple(settings, pose_error(Pose{{1e5, 0, 0}, axis}, Pose{{1e5, 0, 0}, axis}), {}, {});
    EXPECT_EQ(same.on_device, Wrench{});
    EXPECT_EQ(same.energy, 0);
  }
}

TEST(Coupling, ForceGrowsToTheStretchLimitAndStays) {
  const CouplingSettings settings = springs_only();
  for (const double x : {0.0, 1e-12, 1.0, 4.999, 5.0, 5.001, 50.0, 1e5}) {
    const auto w = couple(settings, {{x, 0, 0}, {}}, {}, {});
    EXPECT_DOUBLE_EQ(w.on_tool.force.x, settings.stiffness * std::min(x, settings.max_stretch));
    EXPECT_LE(w.energy, settings.capacity(x) * (1 + 1e-15));
  }
}

TEST(Coupling, SettingsNameTheFieldThatIsWrong) {
  const auto message = [](auto change) {
    CouplingSettings s;
    change(s);
    return test::error_of([&] { s.validate(); });
  };
  EXPECT_EQ(message([](auto& s) { s.stiffness = -1; }), "stiffness must not be negative");
  EXPECT_EQ(message([](auto& s) { s.turn_damping = NAN; }), "turn_damping must not be negative");
  EXPECT_EQ(message([](auto& s) { s.max_stretch = 0; }), "max_stretch must be positive");
  EXPECT_NE(message([](auto& s) { s.max_turn = 2; }).find("max_turn must be a number between"), std::string::npos);
  EXPECT_NO_THROW(CouplingSettings{}.validate());
}

}  // namespace
}  // namespace riffler::haptics::coupling_test
