// Damping by posture of a pen's file that `riffler pen identify` wrote (identified.toml), and of files that it would
// not.
#include "stress/identified_damping.hpp"

#include <gtest/gtest.h>

#include "pen/arms/joint_losses.hpp"
#include "pen/arms/pens.hpp"
#include "riffler/pen/arms/kinematics.hpp"
#include "stress/random.hpp"
#include "support/checkout.hpp"
#include "support/error_of.hpp"

namespace riffler::stress::identified_damping_test {
namespace {

pen::PenGeometry identified() {
  return pen::load_pen((test::checkout() / "native/tests/stress/identified.toml").string());
}

/// By directions spread over the sphere, each made better by small steps.
double least_by_search(const Mat3& matrix, Random& random) {
  double least = 1e300;
  for (int k = 0; k < 30; ++k) {
    Vec3 v = random.direction();
    const auto value = [&](const Vec3& u) { return glm::dot(u, matrix * u); };
    for (double step = 0.5; step > 1e-7; step *= 0.9)
      for (int n = 0; n < 6; ++n) {
        const Vec3 other = glm::normalize(v + step * random.direction());
        if (value(other) < value(v)) v = other;
      }
    least = std::min(least, value(v));
  }
  return least;
}

TEST(LeastEigenvalue, IsTheSmallestPowerOfAnyDirection) {
  Random random(1);
  for (int k = 0; k < 50; ++k) {
    const Mat3 root(random.direction(), random.direction(), random.direction());
    const Mat3 matrix = glm::transpose(root) * root;
    EXPECT_NEAR(least_eigenvalue(matrix), least_by_search(matrix, random), 1e-5);
  }
  EXPECT_EQ(least_eigenvalue(Mat3(0)), 0);
  EXPECT_EQ(least_eigenvalue(3.0 * Mat3(1)), 3);
  const Vec3 u = glm::normalize(Vec3(1, 2, 3));
  EXPECT_NEAR(least_eigenvalue(glm::outerProduct(u, u)), 0, 1e-7) << "singular";
}

TEST(IdentifiedDamping, TheFileOfAnIdentifiedPenHasDampingInEveryPosture) {
  const pen::PenGeometry pen = identified();
  const IdentifiedDamping found = identified_damping(pen, 300);
  EXPECT_EQ(found.postures, 300);
  EXPECT_GT(found.worst, 0);
  EXPECT_GE(found.median, found.worst);
  const pen::PenKinematics kinematics(pen);
  Random random(2);
  EXPECT_NEAR(
      found.home / least_by_search(pivot_damping(kinematics, kinematics.posture(kinematics.home_angles())), random), 1,
      1e-4);
  EXPECT_GT(found.step, 0.01);
  EXPECT_LT(found.step, 0.1);
  EXPECT_GT(found.friction, 0.005);
}

TEST(IdentifiedDamping, UncertainViscousFrictionGivesNoDamping) {
  pen::PenGeometry pen = identified();
  for (std::size_t k = 0; k < pen::kPenChannels; ++k) pen.uncertainty->viscous[k] = 10 * pen.channels[k].viscous;
  const IdentifiedDamping found = identified_damping(pen, 50);
  EXPECT_EQ(found.home, 0);
  EXPECT_EQ(found.worst, 0);
  EXPECT_GT(found.friction, 0);
}

TEST(IdentifiedDamping, RefusesUnknownPens) {
  EXPECT_NE(test::error_of([] { identified_damping(pen::load_pen("riffler")); }).find("riffler pen identify"),
            std::string::npos);
  pen::PenGeometry pen = identified();
  pen.workspace = {{5000, 5000, 5000}, {5100, 5100, 5100}};
  EXPECT_NE(test::error_of([&] { identified_damping(pen, 20); }).find("limits.lower"), std::string::npos);
}

}  // namespace
}  // namespace riffler::stress::identified_damping_test
