#include "dexel/from_mesh/field_points.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "sweep/kernels.hpp"

namespace riffler::dexel::field_points_test {
namespace {

struct Sums {
  FieldValues some{}, all{};
  std::array<double, kPoints> variation{};

  bool operator==(const Sums& o) const { return std::memcmp(this, &o, sizeof o) == 0; }
};

TEST(FieldPoints, AreTheSameBitsForAllInstructionSets) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal(0, 30);
  for (std::size_t round = 0; round < 300; ++round) {
    std::vector<PathPoint> path;
    for (std::size_t k = 0; k <= round % 40; ++k) {
      const Vec3 p(normal(random), std::round(normal(random)), normal(random));
      const bool joined = k > 0 && random() % 5 != 0, finite = random() % 5 != 0;
      path.push_back({p.x, p.y, p.z, joined, finite, random() % 3 == 0, 1 / glm::dot(p, p), glm::length(p),
                      random() % 2 == 0 ? 5 : std::numeric_limits<double>::infinity()});
    }
    FieldPoints points;
    std::array<double, kPoints> slopes;
    for (int k = 0; k < kPoints; ++k) {
      points.x[k] = normal(random), points.y[k] = std::round(normal(random)), points.z[k] = normal(random);
      points.half_x[k] = 1, points.half_y[k] = 2, points.half_z[k] = 3, slopes[k] = normal(random);
    }
    LocalExpansion far;
    SourceSum sources{};
    for (double& c : sources.c_re) c = 1e-3 * normal(random);
    for (double& c : sources.c_im) c = 1e-3 * normal(random);
    far.add(sources);
    const auto sums = [&](const std::string& instruction_set) {
      sweep::use_instruction_set(instruction_set);
      Sums out;
      evaluate_field(path, far, Vec3(1, 2, 3), points, false, out.some);
      evaluate_field(path, far, Vec3(1, 2, 3), points, true, out.all);
      field_variation(path, points, slopes.data(), 0.1, out.variation.data());
      return out;
    };
    const Sums best = sums("");
    for (const std::string& name : sweep::instruction_sets()) EXPECT_TRUE(sums(name) == best) << name;
    sweep::use_instruction_set("");
    // What is asked for is the same however much.
    EXPECT_EQ(std::memcmp(best.some.gz, best.all.gz, sizeof best.all.gz), 0);
    EXPECT_EQ(std::memcmp(best.some.phase, best.all.phase, sizeof best.all.phase), 0);
  }
}

}  // namespace
}  // namespace riffler::dexel::field_points_test
