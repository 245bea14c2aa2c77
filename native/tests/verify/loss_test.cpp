#include "verify/loss.hpp"

#include <gtest/gtest.h>

#include "stress/random.hpp"

namespace riffler::verify::loss_test {
namespace {

using Pieces = std::vector<std::pair<double, double>>;

Pieces loss(const std::vector<dexel::Span>& before, const std::vector<dexel::Span>& after) {
  Pieces out;
  for_each_loss_on_ray(before, after, [&](double near, double far) { out.emplace_back(near, far); });
  return out;
}

TEST(Loss, PiecesOfARayAreFoundOneByOne) {
  EXPECT_EQ(loss({}, {}), Pieces());
  EXPECT_EQ(loss({{0, 4}}, {}), (Pieces{{0, 4}}));
  EXPECT_EQ(loss({{0, 4}}, {{0, 4}}), Pieces());
  EXPECT_EQ(loss({{0, 4}}, {{1, 2}, {3, 4}}), (Pieces{{0, 1}, {2, 3}}));
  EXPECT_EQ(loss({{0, 4}, {6, 8}}, {{1, 2}, {6, 7}}), (Pieces{{0, 1}, {2, 4}, {7, 8}}));
  EXPECT_EQ(loss({{0, 4}, {6, 8}}, {{6, 8}}), (Pieces{{0, 4}}));
}

TEST(Loss, RemainingMaterialMayReachOverSeveralSpans) {
  // As with a part's spans against a stock's.
  EXPECT_EQ(loss({{0, 1}, {2, 3}, {5, 9}}, {{-1, 6}, {8, 20}}), (Pieces{{6, 8}}));
}

TEST(Loss, RandomRaysLoseAsMuchAsACountOfPoints) {
  stress::Random random(7);
  for (int round = 0; round < 2000; ++round) {
    bool before[24], after[24];
    std::vector<dexel::Span> spans[2];
    for (int i = 0; i < 24; ++i) before[i] = random.one_in(2), after[i] = random.one_in(2);
    for (int which = 0; which < 2; ++which)
      for (int i = 0; i < 24; ++i) {
        const bool* on = which == 0 ? before : after;
        if (!on[i]) continue;
        if (i > 0 && on[i - 1])
          spans[which].back().far = i + 1;
        else
          spans[which].push_back({static_cast<double>(i), i + 1.0});
      }
    bool lost[24] = {};
    for (const auto& [near, far] : loss(spans[0], spans[1]))
      for (int i = static_cast<int>(near); i < static_cast<int>(far); ++i) lost[i] = true;
    for (int i = 0; i < 24; ++i) EXPECT_EQ(lost[i], before[i] && !after[i]);
  }
}

}  // namespace
}  // namespace riffler::verify::loss_test
