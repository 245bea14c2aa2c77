#include "nc/read/drill_cycle.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "support/nc_reading.hpp"

namespace riffler::nc::drill_cycle_test {
namespace {

using test::nc_error;
using test::read_nc_text;

using Heights = std::vector<std::pair<double, bool>>;

Heights heights(const DrillCycle& cycle) {
  Heights out;
  drill(cycle, NcPlace{}, [&](double z, bool rapid) { out.emplace_back(z, rapid); });
  return out;
}

TEST(DrillCycle, MovesAsItsCodeDescribes) {
  EXPECT_EQ(heights({810, 2, -5, 2, 0}), (Heights{{-5, false}, {2, true}}));
  EXPECT_EQ(heights({810, 2, -5, 10, 0}), (Heights{{-5, false}, {10, true}}));
  EXPECT_EQ(heights({850, 2, -5, 10, 0}), (Heights{{-5, false}, {2, false}, {10, true}}));
  EXPECT_EQ(heights({890, 2, -5, 2, 0}), (Heights{{-5, false}, {2, false}}));
  EXPECT_EQ(heights({830, 2, -5, 2, 4}), (Heights{{-2, false}, {2, true}, {-2 + 0.254, true}, {-5, false}, {2, true}}));
  EXPECT_EQ(heights({730, 2, -5, 2, 4}), (Heights{{-2, false}, {-2 + 0.254, true}, {-5, false}, {2, true}}));
  EXPECT_EQ(heights({830, 2, -5, 2, 99}), (Heights{{-5, false}, {2, true}}));
}

TEST(DrillCycle, StaysUntilAnotherMotion) {
  const Program p = read_nc_text("F100\nG0 Z10\nG98 G81 X1 Y2 Z-3 R1\nX5\nG80\nG0 X0");
  ASSERT_EQ(p.size(), 10U);
  const Vec3 wanted[] = {{0, 0, 10}, {1, 2, 10}, {1, 2, 1},  {1, 2, -3}, {1, 2, 10},
                         {5, 2, 10}, {5, 2, 1},  {5, 2, -3}, {5, 2, 10}, {0, 2, 10}};
  for (std::size_t k = 0; k < 10; ++k) EXPECT_EQ(p.poses()[k].tip, wanted[k]) << k;
  EXPECT_EQ(p.rapid(), (std::vector<std::uint8_t>{1, 1, 1, 0, 1, 1, 1, 0, 1, 1}));
  EXPECT_EQ(p.line(), (std::vector<std::int32_t>{2, 3, 3, 3, 3, 4, 4, 4, 4, 6}));
  EXPECT_EQ(read_nc_text("F1\nG91 G81 X1 Z-2 R1 L3").poses().back().tip.x, 3);
}

TEST(DrillCycle, IsRefusedWithoutItsWords) {
  const std::pair<const char*, const char*> cases[] = {
      {"G81 X1 Z-1", "a canned cycle needs R, the height above which it moves fast"},
      {"G81 X1 R1", "a canned cycle needs Z, its depth"},
      {"G18 G81 X1 Z1 R1", "a canned cycle needs Y, its depth"},
      {"G83 X1 R1 Z-1", "a canned cycle needs Q, the depth of a peck"},
      {"G83 X1 R1 Z-1 Q0", "Q must be positive"},
      {"G83 X1 R1 Z-1 Q.000001", "Q is too small: too many pecks"},
      {"G81 X1 R1 Z2", "the canned cycle's R is below its depth"},
      {"G81 X1 R1 Z-1 L0", "L must be at least 1"},
      {"G81 X1 R1 Z-1 A5", "rotary axes do not turn in canned cycles"},
      {"G81", "a canned cycle without axis words"},
      {"G86 X1 R1 Z-1 P1", "G86 needs a spindle that turns (M3, M4)"},
      {"G93 G81 X1 R1 Z-1 F1", "canned cycles do not support inverse time (G93)"},
      {"G38.2 Z-1", "probing (G38) cannot be simulated: only the machine knows where it ends"},
      {"G76 Z-1", "threads (G33, G33.1, G76) are cut by the spindle's position: they are not read"},
      {"G5.2 X1", "NURBS (G5.2, G5.3) are not read: have the CAM system write arcs or lines"},
  };
  for (const auto& [text, what] : cases)
    EXPECT_EQ(nc_error(std::string("F100\n") + text), std::string("line 2: ") + what + " [" + text + "]");
  EXPECT_EQ(nc_error("G0 X1\nG81 X1 R1 Z-1"),
            "line 2: a feed move without F: option first_feed, mm/min, holds until the first F [G81 X1 R1 Z-1]");
}

TEST(NcDrillCycle, TooManyMovesAreRefusedBeforeTheyAreMade) {
  EXPECT_NE(test::nc_error("G91 F100\nG81 X1 Z-1 R1 L99999999").find("too many moves"), std::string::npos);
}

}  // namespace
}  // namespace riffler::nc::drill_cycle_test
