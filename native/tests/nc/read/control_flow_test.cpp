#include "nc/read/control_flow.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "support/nc_reading.hpp"

namespace riffler::nc::control_flow_test {
namespace {

using test::nc_error;
using test::read_nc_text;

std::vector<double> xs(const std::string& text) {
  const Program program = read_nc_text("G0\n" + text);
  std::vector<double> out;
  for (const Pose& pose : program.poses()) out.push_back(pose.tip.x);
  return out;
}
using Xs = std::vector<double>;

TEST(NcControlFlow, TakesTheBranchWhoseConditionHolds) {
  const std::string text = "o1 if [#1 EQ 1]\nX1\no1 elseif [#1 EQ 2]\nX2\no1 else\nX3\no1 endif\nX9";
  EXPECT_EQ(xs("#1=1\n" + text), (Xs{1, 9}));
  EXPECT_EQ(xs("#1=2\n" + text), (Xs{2, 9}));
  EXPECT_EQ(xs("#1=5\n" + text), (Xs{3, 9}));
  EXPECT_EQ(xs("o1 if [0]\nX)\no1 endif\nX9"), (Xs{9})) << "what is passed over is not read";
}

TEST(NcControlFlow, LoopsAsLongAsTheirConditionHolds) {
  EXPECT_EQ(xs("#1=0\no1 while [#1 LT 3]\nX#1\n#1=[#1+1]\no1 endwhile\nX9"), (Xs{0, 1, 2, 9}));
  EXPECT_EQ(xs("#1=5\no1 do\nX#1\n#1=[#1+1]\no1 while [#1 LT 3]\nX9"), (Xs{5, 9}));
  EXPECT_EQ(xs("o1 repeat [3]\nG91 X1\no1 endrepeat"), (Xs{1, 2, 3}));
  EXPECT_EQ(xs("o1 repeat [0]\nX5\no1 endrepeat\nX9"), (Xs{9}));
  EXPECT_EQ(xs("G91\no1 repeat [2]\no2 repeat [3]\nX1\no2 endrepeat\nX10\no1 endrepeat"),
            (Xs{1, 2, 3, 13, 14, 15, 16, 26}));
  EXPECT_EQ(
      xs("#1=0\no1 while [#1 LT 5]\n#1=[#1+1]\no2 if [#1 EQ 2]\no1 continue\no2 endif\no2 if [#1 EQ 4]\no1 break\n"
         "o2 endif\nX#1\no1 endwhile\nX9"),
      (Xs{1, 3, 9}));
  EXPECT_EQ(xs("#1=0\no1 do\n#1=[#1+1]\no2 if [#1 LE 2]\no1 continue\no2 endif\nX#1\no1 while [#1 LT 4]"), (Xs{3, 4}));
}

TEST(NcControlFlow, CallsSubroutinesWithArgumentsAndValues) {
  EXPECT_EQ(
      xs("#1=7\no1 sub\nX#1\nX#2\n#1=99\no1 endsub [#2+1]\no1 call [3] [4]\nX#1\nX#<_value>\nX#<_value_returned>"),
      (Xs{3, 4, 7, 5, 1}));
  EXPECT_EQ(xs("o<Half of> sub\no1 if [#1 LT 0]\no7 return\no1 endif\nX#1\no<halfof> endsub\n"
               "o<half OF> call [1]\no<half of> call [-1]\nX#<_value_returned>"),
            (Xs{1, 0}))
      << "a return may have any label";
  EXPECT_EQ(xs("o2 call [3]\nM2\no2 sub\nX#1\no3 if [#1 GT 0]\no2 call [#1-1]\no3 endif\no2 endsub"), (Xs{3, 2, 1, 0}))
      << "recursion; the subroutine after the end";
  EXPECT_EQ(xs("#<a>=1 #<_b_>=2\no1 sub\nX#<_b_>\n#<a>=5\nX#<a>\no1 endsub\no1 call\nX#<a>"), (Xs{2, 5, 1}));
  EXPECT_EQ(xs("#1=5\no[2+#1] call [1]\nM2\no7 sub\nX#1\no7 endsub"), (Xs{1}));
}

TEST(NcControlFlow, CallsSubprogramsAfterTheEnd) {
  EXPECT_EQ(xs("G91 M98 P12 L3\nX10\nM30\nO12\nX1\nM99\n"), (Xs{1, 2, 3, 13}));
  EXPECT_EQ(nc_error("M98 P12"),
            "line 1: no subroutine O12: neither in the program, nor as 12.ngc in its folder or that of option "
            "subroutines [M98 P12]");
}

TEST(NcControlFlow, FindsSubroutinesInFilesNextToTheProgramAndInTheirFolder) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / ("riffler_subs_" + std::to_string(getpid()));
  fs::create_directories(folder / "subs");
  std::ofstream(folder / "main.ngc") << "G0 X1\n\no<near> call [2]\no<other> call\nX9\nM2\n";
  std::ofstream(folder / "near.ngc") << "(a file)\no<near> sub\nX#1\no<near> endsub\nM2\n";
  std::ofstream(folder / "subs" / "other.ngc")
      << "o<other> sub\no<inner> call\no<other> endsub\no<inner> sub\nX5\no<inner> endsub";
  const Program p = read_nc(folder / "main.ngc", {"tcp", {{"subroutines", (folder / "subs").string()}}});
  Xs x;
  for (const Pose& pose : p.poses()) x.push_back(pose.tip.x);
  EXPECT_EQ(x, (Xs{1, 2, 5, 9}));
  EXPECT_EQ(p.line(), (std::vector<std::int32_t>{1, 3, 4, 5})) << "lines of the program";
  std::ofstream(folder / "near.ngc") << "o<near> sub\nX\no<near> endsub";
  try {
    read_nc(folder / "main.ngc");
    ADD_FAILURE();
  } catch (const FormatError& e) {
    EXPECT_EQ(std::string(e.what()), "near.ngc, line 2: expected a number after X [X]");
  }
  fs::remove_all(folder);
}

TEST(NcControlFlow, RefusesEndlessLoops) {
  const std::pair<const char*, const char*> cases[] = {
      {"o1 while [1]\no1 endwhile",
       "line 2: an endless loop? More turns of loops and calls than option max_turns allows"},
      {"o1 sub\no1 call\no1 endsub\no1 call", "line 2: calls nested more than 10 deep"},
      {"o1 if [0]\nG0", "line 1: O1 has no end"},
      {"o1 sub\nG0", "line 1: O1 has no end"},
      {"G0\no1 repeat [0]", "line 2: O1 has no end"},
      {"o1 endwhile", "line 1: not within loop O1"},
      {"o1 break", "line 1: not within loop O1"},
      {"o1 if [1]\no1 break", "line 2: not within loop O1"},
      {"o1 endif", "line 1: not within branch O1"},
      {"o1 else", "line 1: not within branch O1"},
      {"o1 repeat [1]\no1 endif", "line 2: not within branch O1"},
      {"o1 return", "line 1: not within subroutine O1"},
      {"o1 sub\no2 endsub\no1 endsub\no1 call", "line 2: not within subroutine O2"},
      {"o1 if 5", "line 1: expected a value in brackets after an O-word"},
      {"o1 if [1] G0", "line 1: text after an O-word: an O-word must be alone on its line"},
      {"o1 loop", "line 1: unknown word after O1: LOOP"},
      {"o call", "line 1: expected a number or <name> after O"},
      {"o1.5 call", "line 1: O must be a whole number"},
      {"G0 o1 call", "line 1: an O-word must be first in its block"},
      {"o<../a> call", "line 1: no subroutine O<../a>"},
      {"o1 sub\no2 sub\no2 endsub\no1 endsub\no1 call", "line 2: a subroutine within subroutine O1"},
      {"M72", "line 1: M72 without M70 or M73 in the same subroutine"},
  };
  for (const auto& [text, what] : cases) {
    const std::string error = nc_error(text, "tcp", {{"max_turns", 1000.0}});
    EXPECT_EQ(error.substr(0, std::string(what).size()), what) << text;
    EXPECT_EQ(error.back(), error.find("has no end") == error.npos ? ']' : 'd') << error;
  }
}

TEST(NcControlFlow, RestoresModesThatASubroutineChanged) {
  EXPECT_EQ(xs("G91\no1 sub\nM73\nG90 G20\nX1\no1 endsub\no1 call\nX1"), (Xs{25.4, 26.4}));
  EXPECT_EQ(xs("M70\nG91 X5\nX5\nM72\nX5\nM71"), (Xs{5, 10, 5}));
}

TEST(NcControlFlow, LinesThatEveryIterationSkipsAreCountedToo) {
  std::string text = "o1 repeat [999990]\no2 if [0]\n";
  for (int k = 0; k < 20'000; ++k) text += "G1 X1\n";
  text += "o2 endif\no1 endrepeat\nM2\n";
  EXPECT_NE(nc_error(text, "tcp", {{"max_turns", 1000.0}}).find("endless"), std::string::npos);
  int asked = 0;
  EXPECT_THROW(parse_nc(text, "a.ngc", {"tcp", {}, [&](double) { return ++asked < 3; }}), Cancelled);
  EXPECT_EQ(asked, 3);
}

TEST(NcControlFlow, ALongProgramWithoutLoopsHasNoBound) {
  std::string text = "G1 F100\n";
  for (int k = 0; k < 20'000; ++k) text += "X1\n";
  double last = 0;
  const Program p = parse_nc(text, "a.ngc", {"tcp", {{"max_turns", 1.0}}, [&](double share) {
                                               EXPECT_GE(share, last);
                                               last = share;
                                               return true;
                                             }});
  EXPECT_EQ(p.size(), 20'000U);
  EXPECT_GT(last, 0.5);
}

}  // namespace
}  // namespace riffler::nc::control_flow_test
