// CUTTER statements: every shape that has one comes back from it.
#include "nc/apt_cutter.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "geom/math.hpp"
#include "riffler/base/error.hpp"

namespace riffler::nc::apt_cutter_test {
namespace {

TEST(AptCutter, TheStatementGivesBackTheCutter) {
  const NcPlace place{};
  for (const tool::CutterShape& shape : tool::cutter_shapes()) {
    EXPECT_EQ(shape.to_apt == nullptr, shape.from_apt == nullptr) << shape.name;
    if (!shape.to_apt) continue;
    for (const double scale : {0.01, 1.0, 12.0}) {
      std::vector<double> sizes;
      for (const tool::CutterSize& size : shape.sizes)
        sizes.push_back(size.unit == tool::SizeUnit::Length ? scale * size.initial : size.initial);
      const Tool tool = make_cutter(shape, sizes);
      const std::optional<tool::AptCutter> apt = to_apt(tool);
      ASSERT_TRUE(apt) << shape.name;
      const auto again =
          apt_cutter({apt->d, apt->r, apt->e, apt->f, apt->a / kDegree, apt->b / kDegree, apt->h}, 1, place);
      ASSERT_TRUE(again) << shape.name;
      EXPECT_EQ(again->kind(), tool.kind());
      // The same solid as far as both are sharp: APT has no cylinder above a cone.
      const auto &a = tool.profile().segments().front(), &b = again->profile().segments().front();
      EXPECT_LT(glm::length(a.to - b.to), 1e-12 * scale) << shape.name;
      EXPECT_EQ(again->length(), tool.length());
    }
  }
  EXPECT_FALSE(to_apt(cutters::profile({{{1, 1}, {}}}, 3)));
}

TEST(AptCutter, StatementsThatMatchNoShapeGiveNone) {
  const NcPlace place{};
  for (const std::vector<double>& numbers : {std::vector<double>{10, 5, 0, 5, 0, 0},  // no length
                                             {10, 2, 0, 2, 0, 0, 50},                 // the corner's centre elsewhere
                                             {10, 2, 3, 2, 5, 0, 50},                 // a pointed end
                                             {10, 2, 3, 2, 0, 5, 50},                 // a cone above a corner
                                             {10, 0, 5, 0, 0, -5, 50},                // narrows upwards
                                             {10, 0, 5, 0, 0, 0, 0},
                                             {0, 0, 0, 0, 0, 0, 50}})
    EXPECT_FALSE(apt_cutter(numbers, 1, place)) << numbers.back();
  EXPECT_THROW(apt_cutter({10, 6, -1, 6, 0, 0, 50}, 1, place), FormatError) << "a corner wider than the cutter";
}

}  // namespace
}  // namespace riffler::nc::apt_cutter_test
