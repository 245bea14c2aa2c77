#include "dexel/from_mesh/field_sum.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <random>
#include <vector>

#include "sweep/kernels.hpp"

namespace riffler::dexel::field_sum_test {
namespace {

TEST(FieldSums, AreTheSameBitsForAllInstructionSets) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal(0, 30);
  for (std::size_t round = 0; round < 500; ++round) {
    const std::size_t n = kSourceLanes * (1 + round % 20);
    std::array<std::vector<double>, 10> a;
    for (auto& values : a)
      for (std::size_t k = 0; k < n; ++k) values.push_back(normal(random));
    for (double& flag : a[9]) flag = flag > 20;
    for (const bool dipoles : {false, true}) {
      const auto sum = [&](const std::string& instruction_set) {
        sweep::use_instruction_set(instruction_set);
        return sum_sources({a[0].data(), a[1].data(), a[2].data(), a[3].data(), a[4].data(), a[5].data(), a[6].data(),
                            a[7].data(), a[8].data(), a[9].data(), n, dipoles});
      };
      const SourceSum best = sum("");
      for (const std::string& name : sweep::instruction_sets()) {
        const SourceSum other = sum(name);
        EXPECT_EQ(std::memcmp(&best, &other, sizeof best), 0) << name;
      }
      sweep::use_instruction_set("");
    }
  }
}

}  // namespace
}  // namespace riffler::dexel::field_sum_test
