#include "riffler/base/check.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <utility>

#include "support/error_of.hpp"

namespace riffler::base::check_test {
namespace {

TEST(Numbers, AreRefusedByNameWithTheirRange) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity(), kNaN = std::numeric_limits<double>::quiet_NaN();
  const std::string range = "tolerance must be a positive length in mm, from 1e-08 to 1e+30, not ";
  for (const auto& [bad, figures] :
       {std::pair{0.0, "0"}, {-1.0, "-1"}, {1e-9, "1e-09"}, {kInfinity, "inf"}, {kNaN, "nan"}})
    EXPECT_EQ(test::error_of([&, bad = bad] { require_tolerance(bad); }), range + figures);
  EXPECT_NE(test::error_of([] { require_tolerance(5e-324); }), "");
  require_tolerance(1e-6);
  require_tolerance_for(1e-6, 100);
  EXPECT_NE(test::error_of([] { require_tolerance_for(1e-6, 1e5); }), "");
  EXPECT_NE(test::error_of([&] { require_angle(kNaN, "tilt"); }).find("tilt"), std::string::npos);
  EXPECT_NE(test::error_of([&] { require_time(5e-324, "dt"); }).find("dt"), std::string::npos);
  EXPECT_EQ(test::error_of([&] { require_finite(kNaN, "height"); }), "height must be finite, not nan");
}

}  // namespace
}  // namespace riffler::base::check_test
