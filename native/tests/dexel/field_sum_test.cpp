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
    const std::size_t n = kLanes * (1 + round % 20);
    std::array<std::vector<double>, 11> a;
    for (auto& values : a)
      for (std::size_t k = 0; k <= n; ++k) values.push_back(normal(random));
    for (double& rr : a[3]) rr *= rr;
    for (const int flags : {6, 7})
      for (double& flag : a[flags]) flag = flag > -20;
    std::vector<double> scratch(4 * (n + 1));
    const EdgeArrays edges{a[0].data(), a[1].data(), a[2].data(), a[3].data(),    a[4].data(),
                           a[5].data(), a[6].data(), a[7].data(), scratch.data(), n};
    const SourceArrays sources{a[0].data(), a[1].data(),  a[2].data(), a[4].data(), a[5].data(), a[8].data(),
                               a[9].data(), a[10].data(), a[3].data(), a[6].data(), a[7].data(), n};
    const double z = normal(random);
    const auto& all = FieldSums::available();
    for (const FieldSums& sums : all)
      for (const bool full : {false, true}) {
        const EdgeSum first = all.front().edges(edges, z, full), other = sums.edges(edges, z, full);
        EXPECT_EQ(std::memcmp(&first, &other, sizeof first), 0);
        const SourceSum source = all.front().sources(sources), another = sums.sources(sources);
        EXPECT_EQ(std::memcmp(&source, &another, sizeof source), 0);
      }
  }
}

}  // namespace
}  // namespace riffler
