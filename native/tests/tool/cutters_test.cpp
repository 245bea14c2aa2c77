// The table of cutters: every row holds to the same rules, so that a new one is tested by standing in it.
#include "riffler/tool/cutters.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <string>

#include "support/error_of.hpp"

namespace riffler::tool::cutters_test {
namespace {

/// First values of a form's fields, lengths scaled.
std::vector<double> initial_sizes(const CutterShape& shape, double scale = 1) {
  std::vector<double> out;
  for (const CutterSize& size : shape.sizes)
    out.push_back(size.unit == SizeUnit::Length ? scale * size.initial : size.initial);
  return out;
}

TEST(Cutters, FirstValuesOfAFormMakeACutterOfAnyScale) {
  for (const CutterShape& shape : cutter_shapes())
    for (const double scale : {1e-3, 0.1, 1.0, 7.0, 1e3}) {
      const std::vector<double> sizes = initial_sizes(shape, scale);
      const Tool tool = make_cutter(shape, sizes);
      EXPECT_EQ(tool.kind(), shape.name);
      EXPECT_EQ(sizes_of(tool, shape), sizes) << shape.name;
      EXPECT_NEAR(tool.diameter(), 6 * scale, 1e-9 * scale) << shape.name;
      EXPECT_EQ(tool.length(), 30 * scale) << shape.name;
    }
}

TEST(Cutters, OneSizeMeansTheSameInEveryShape) {
  std::map<std::string, const CutterSize*> known;
  for (const CutterShape& shape : cutter_shapes()) {
    EXPECT_EQ(find_cutter_shape(shape.name), &shape) << "one row for a name";
    std::map<std::string, int> count;
    bool flags = false;
    for (const CutterSize& size : shape.sizes) {
      EXPECT_EQ(++count[size.name], 1) << shape.name;
      EXPECT_TRUE(size.unit == SizeUnit::Flag || !flags) << shape.name << ": flags come last";
      flags = size.unit == SizeUnit::Flag;
      EXPECT_TRUE(size.low <= size.initial && size.initial <= size.high) << size.name;
      const CutterSize& first = *known.try_emplace(size.name, &size).first->second;
      EXPECT_EQ(size.unit, first.unit) << size.name;
      EXPECT_STREQ(size.label, first.label);
      EXPECT_STREQ(size.description, first.description);
      EXPECT_EQ(std::vector({size.low, size.high, size.initial, size.largest}),
                std::vector({first.low, first.high, first.initial, first.largest}));
    }
    EXPECT_EQ(count["diameter"] + count["length"], 2) << shape.name;
  }
  EXPECT_EQ(find_cutter_shape("profile"), nullptr);
  EXPECT_EQ(find_cutter_shape("spoon"), nullptr);
}

TEST(Cutters, EveryInvalidSizeIsRefusedByName) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN(), kInf = std::numeric_limits<double>::infinity();
  for (const CutterShape& shape : cutter_shapes()) {
    for (std::size_t k = 0; k < shape.sizes.size(); ++k)
      for (const double bad : {kNaN, kInf, -kInf, -1.0, 0.0, 2.0}) {
        const CutterSize& size = shape.sizes[k];
        if (size.unit == SizeUnit::Flag || (bad == 0 && size.may_be_zero)) continue;
        if (bad == 2 && size.unit == SizeUnit::Length) continue;  // 2 rad is not a half angle, 2 mm may be a length
        std::vector<double> sizes = initial_sizes(shape);
        sizes[k] = bad;
        EXPECT_EQ(test::error_of([&] { make_cutter(shape, sizes); }).find(size.name), 0U) << shape.name << bad;
      }
    std::vector<double> sizes = initial_sizes(shape);
    sizes.pop_back();
    EXPECT_NE(test::error_of([&] { make_cutter(shape, sizes); }), "") << shape.name;
  }
}

}  // namespace
}  // namespace riffler::tool::cutters_test
