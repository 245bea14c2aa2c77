#include "dexel/field_sum.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <random>

namespace riffler {
namespace {

TEST(FieldSums, AreTheSameBitsForAllInstructionSets) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal(0, 30);
  for (std::size_t round = 0; round < 500; ++round) {
    const std::size_t n = kSourceLanes * (1 + round % 20);
    std::array<std::vector<double>, 11> a;
    for (auto& values : a)
      for (std::size_t k = 0; k <= n; ++k) values.push_back(normal(random));
    for (const int flags : {6, 7})
      for (double& flag : a[flags]) flag = flag > -20;
    const SourceArrays sources{a[0].data(), a[1].data(),  a[2].data(), a[4].data(), a[5].data(), a[8].data(),
                               a[9].data(), a[10].data(), a[3].data(), a[6].data(), a[7].data(), n};
    const auto& all = FieldSums::available();
    for (const FieldSums& sums : all) {
      const SourceSum source = all.front().sources(sources), another = sums.sources(sources);
      EXPECT_EQ(std::memcmp(&source, &another, sizeof source), 0);
    }
  }
}

}  // namespace
}  // namespace riffler
