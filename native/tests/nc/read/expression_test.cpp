#include "nc/read/expression.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "support/nc_reading.hpp"

namespace riffler::nc::expression_test {
namespace {

using test::nc_error;
using test::nc_x;

TEST(NcExpression, BindsOperatorsAsLinuxCncDoes) {
  // Each value is what rs274 of LinuxCNC 2.9 makes of it.
  const std::pair<const char*, double> cases[] = {
      {"[2 ** 3 ** 2]", 64},
      {"[2 + 3 * 4 ** 2 / 2]", 26},
      {"[10 - 4 - 3]", 3},
      {"[-2 ** 2]", 4},
      {"[7 MOD -3]", 1},
      {"[-7 MOD 3]", 2},
      {"[1 OR 0 AND 0]", 0},
      {"[1 AND 2 XOR 1]", 0},
      {"[1 LT 2 EQ 1]", 1},
      {"[1 EQ 1.00005]", 1},
      {"[1 NE 1.00005]", 0},
      {"[1.00005 GT 1]", 1},
      {"[1 GE 1.00005]", 0},
      {"[2 LE 2]", 1},
      {"[1+[2*3]-ABS[-4]]", 3},
      {"-[3]", -3},
      {"+[4]", 4},
      {"ROUND[-2.5]", -3},
      {"FIX[-2.5]", -3},
      {"FUP[-2.5]", -2},
      {"SQRT[16]", 4},
      {"[3*-2]", -6},
      {"[2--3]", 5},
  };
  for (const auto& [text, value] : cases) EXPECT_EQ(nc_x(text), value) << text;
  const std::pair<const char*, double> angles[] = {{"ATAN[1]/[-1]", 135},
                                                   {"ACOS[0.5]", 60},
                                                   {"ASIN[0.5]", 30},
                                                   {"TAN[45]", 1},
                                                   {"COS[60]", 0.5},
                                                   {"SIN[30]", 0.5},
                                                   {"EXP[1]", 2.718281828459045},
                                                   {"LN[10]", 2.302585092994046}};
  for (const auto& [text, value] : angles) EXPECT_NEAR(nc_x(text), value, 1e-13) << text;
}

TEST(NcExpression, ReadsParametersOfEveryForm) {
  EXPECT_EQ(nc_x("#2", "#1=1 #2=[#1+1]"), 1) << "assignments take effect after the block";
  EXPECT_EQ(nc_x("##3", "#3=4\n#4=7"), 7);
  EXPECT_EQ(nc_x("#[1+1]", "#2=9"), 9);
  EXPECT_EQ(nc_x("-#2", "#2=9"), -9);
  EXPECT_EQ(nc_x("#<A name>", "#<aNa me>=3"), 3);
  EXPECT_EQ(nc_x("[EXISTS[#<a>] + 10 * EXISTS[#<b>] + 100 * EXISTS[#<_x>]]", "#<a>=1"), 101);
  EXPECT_EQ(nc_x("#100"), 0) << "numbers are 0 before they are assigned";
  EXPECT_EQ(nc_x("#1 #1=5", "#1=3"), 3);
  const Program p = test::read_nc_text("G0 X3 Y4\nG20\nG0 X[#5420 * 2] Y#<_y> Z[#<_metric> + 2 * #<_imperial>]");
  EXPECT_NEAR(p.poses()[1].tip.x, 6, 1e-12);
  EXPECT_NEAR(p.poses()[1].tip.y, 4, 1e-12);
  EXPECT_NEAR(p.poses()[1].tip.z, 2 * 25.4, 1e-12);
}

TEST(NcExpression, RefusesExpressionsWithoutAValue) {
  const std::pair<const char*, const char*> cases[] = {
      {"[1/0]", "division by zero"},
      {"[1 MOD 0]", "division by zero"},
      {"[[-2] ** 0.5]", "a negative number to a power that is not whole"},
      {"SQRT[-1]", "SQRT of a number for which it has no value"},
      {"LN[0]", "LN of a number for which it has no value"},
      {"ACOS[1.5]", "ACOS of a number for which it has no value"},
      {"[1 + 2", "an expression that is not closed by ]"},
      {"[1 2]", "expected an operator or ] in an expression"},
      {"[]", "expected a number after ["},
      {"SIN 30", "expected [ after SIN"},
      {"ATAN[1]", "ATAN takes two values: ATAN[y]/[x]"},
      {"EXISTS[1]", "EXISTS needs a name: EXISTS[#<name>]"},
      {"[EXP[99999]]", "an expression whose value is not finite"},
      {"[10 ** 400]", "an expression whose value is not finite"},
      {"#<_nobody>", "parameter #<_nobody> is read before anything is assigned to it"},
      {"#<never>", "parameter #<never> is read before anything is assigned to it"},
      {"#<open", "a name that is not closed by >"},
      {"#0", "parameters have the numbers 1 to 5601"},
      {"#5602", "parameters have the numbers 1 to 5601"},
      {"#1.5", "the number of a parameter must be whole"},
      {"--5", "expected a number after X"},
  };
  for (const auto& [text, what] : cases)
    EXPECT_EQ(nc_error(std::string("\nG0 X") + text), std::string("line 2: ") + what + " [G0 X" + text + "]");
  EXPECT_EQ(nc_error("#5420=1"), "line 1: parameter #5420 is read only [#5420=1]");
  EXPECT_EQ(nc_error("#<_x>=1"), "line 1: parameter #<_x> is read only [#<_x>=1]");
  EXPECT_EQ(nc_error("#1 1"), "line 1: expected = after a parameter [#1 1]");
  EXPECT_NE(nc_error("G0 X" + std::string(5000, '[') + "1").find("nested more than 100 deep"), std::string::npos);
  EXPECT_NE(nc_error("G0 X" + std::string(5000, '#') + "1").find("nested more than 100 deep"), std::string::npos);
  EXPECT_NE(nc_error("G0 X" + std::string(5000, '-') + "1").find("expected a number"), std::string::npos);
}

}  // namespace
}  // namespace riffler::nc::expression_test
