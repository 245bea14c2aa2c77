#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

#include "nurbs/quadrics.hpp"
#include "riffler/nurbs/surface.hpp"
#include "support/error_of.hpp"

namespace riffler::nurbs::check_patch_test {
namespace {

/// Expects an error that contains both texts after `spoil` changed a good patch.
void expect_error(const std::function<void(Patch&)>& spoil, const std::string& where, const std::string& remedy) {
  Patch patch = shapes::torus(10, 3);
  spoil(patch);
  const std::string text = test::error_of([&] { Surface({patch}); });
  EXPECT_NE(text.find(where), std::string::npos) << text;
  EXPECT_NE(text.find(remedy), std::string::npos) << text;
  const std::string second = test::error_of([&] { Surface({shapes::ball(1), patch}); });
  EXPECT_EQ(second, "patch 1: " + text);
}

TEST(SurfacePatch, BadOnesAreRefusedWithPlaceAndRemedy) {
  expect_error([](Patch& p) { p.degree_u = 0; }, "degree_u must be from 1 to 15, not 0", "is a curve");
  expect_error([](Patch& p) { p.degree_v = 16; }, "degree_v must be from 1 to 15, not 16", "lower degree");
  expect_error([](Patch& p) { p.degree_v = 9; }, "points has 9 along v", "needs at least 10");
  expect_error([](Patch& p) { p.knots_u.pop_back(); }, "knots_u has 11 knots, but 9 points of degree 2 need 12",
               "repeated knots");
  expect_error([](Patch& p) { p.knots_v.erase(p.knots_v.begin()), p.knots_v.pop_back(); }, "knots_v has 10 knots",
               "leaves out the first and the last knot");
  expect_error([](Patch& p) { p.knots_u[4] = 0.5; }, "knots_u, row 4: 0.5 after 1", "must not decrease");
  expect_error([](Patch& p) { p.knots_u[4] = std::nan(""); }, "knots_u, row 4: ", "not a finite number");
  expect_error([](Patch& p) { p.knots_u[5] = 1; }, "knots_u, row 3: 1 occurs 3 times", "make a patch of each side");
  expect_error([](Patch& p) { p.knots_v.assign(12, 3); }, "knots_v: the domain", "both are 3");
  expect_error([](Patch& p) { p.weights[10] = 0; }, "weights, row (1, 1): 0 is not positive", "1 everywhere");
  expect_error([](Patch& p) { p.weights[11] = std::nan(""); }, "weights, row (1, 2): ", "1 everywhere");
  expect_error([](Patch& p) { p.weights[12] = -1; }, "weights, row (1, 3): -1", "1 everywhere");
  expect_error([](Patch& p) { p.weights[12] = 1e-13; }, "row (1, 3)", "at most 1e12");
  expect_error([](Patch& p) { p.points[18].y = std::numeric_limits<double>::infinity(); }, "points, row (2, 0)",
               "give mm");
  expect_error([](Patch& p) { p.weights.pop_back(); }, "points and weights", "81");
  EXPECT_NE(test::error_of([] { Surface({}); }).find("at least one patch"), std::string::npos);
}

}  // namespace
}  // namespace riffler::nurbs::check_patch_test
