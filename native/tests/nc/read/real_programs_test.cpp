// Forms that CAM systems and controls write, each of which was once refused, or read as something else.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "support/nc_reading.hpp"

namespace riffler::nc::real_programs_test {
namespace {

using test::nc_error;
using test::read_nc_text;

const Options kSkip{{"unknown", std::string("skip")}};

std::vector<std::string> kinds(const Program& program) {
  std::vector<std::string> out;
  for (const Note& n : program.notes) out.push_back(n.kind);
  return out;
}

void expect_same_moves(const Program& a, const Program& b, const std::string& what) {
  ASSERT_EQ(a.size(), b.size()) << what;
  for (std::size_t row = 0; row < a.size(); ++row) {
    EXPECT_EQ(a.poses()[row].tip, b.poses()[row].tip) << what << ", row " << row;
    EXPECT_EQ(a.feed()[row], b.feed()[row]) << what << ", row " << row;
    EXPECT_EQ(a.rapid()[row], b.rapid()[row]) << what << ", row " << row;
  }
}

TEST(RealPrograms, FormsThatMoveNothingAreAccepted) {
  const std::string moves = "G21 G0 X0 Y0 Z5\nG1 X10 F100\n";
  const Program plain = read_nc_text(moves);
  const std::string headers[] = {"G0 G17 G40 G49 G80 G90",
                                 "G00 G90 G80 G40 G69 G50 G15",
                                 "G97",
                                 "G05 P10000",
                                 "G05.1 Q1",
                                 "G08 P1",
                                 "G53",
                                 "H01",
                                 "G43 H01 D01",
                                 "G0 G90 H00 D00",
                                 ":1234",
                                 ": G90 G40",
                                 "<O1001>",
                                 "% 123",
                                 "%_N_PART_MPF",
                                 "%\nO01001 (JV)",
                                 "\xEF\xBB\xBF%",
                                 "N10.5 G90",
                                 "M19",
                                 "F0",
                                 "G04 X2.",
                                 std::string(40, '\0')};
  for (const std::string& header : headers) {
    const Program read = read_nc_text(header + "\n" + moves);
    expect_same_moves(read, plain, header);
    EXPECT_TRUE(read.notes.empty()) << header << ": " << read.notes[0].message;
  }
  expect_same_moves(read_nc_text("G0 X0 Y0 Z5\r\r\nG1 X10 F100\r\r\n\x1A"), plain, "CR CR LF");
  expect_same_moves(read_nc_text("G0 X0 Y0\nG2 X2 I1 J0 K0.000 F1"), read_nc_text("G0 X0 Y0\nG2 X2 I1 J0 F1"), "K0");
  expect_same_moves(read_nc_text("G0 X0 Y0 Z5 H1 D2\nG1 X10 F100 D2"), plain, "H and D");
}

TEST(RealPrograms, TextAfterTheEndIsNotReadAndNoted) {
  const Program p = read_nc_text("G21 G0 X1\nM30\n(a comment)\nM30\nG0 X2\n%\nnonsense");
  EXPECT_EQ(p.size(), 1U);
  ASSERT_EQ(p.notes.size(), 1U);
  EXPECT_EQ(p.notes[0], (Note{"end", 4, "text after the end of the program is not read"}));
  EXPECT_TRUE(read_nc_text("G21 G0 X1\nM30\n(a comment)\n%\n").notes.empty());
}

TEST(RealPrograms, OptionsSayWhatHoldsAtTheControlsStart) {
  const Options centres{{"arc_centres", std::string("absolute")}};
  const std::string arc = "G21 G0 X50 Y0\nG3 X40 Y10 ";
  expect_same_moves(read_nc_text(arc + "I40 J0 F100", "3-axis", centres), read_nc_text(arc + "I-10 J0 F100"),
                    "centres");
  // The program's own word holds.
  expect_same_moves(read_nc_text("G91.1 " + arc + "I-10 J0 F100", "3-axis", centres),
                    read_nc_text(arc + "I-10 J0 F100"), "G91.1");

  const Options feed{{"first_feed", 250.0}};
  const Program fed = read_nc_text("G20 G0 X0 Y0 Z0\nG1 X1\nG1 X2 F0\nX3 F10\nX4", "3-axis", feed);
  EXPECT_EQ(fed.feed(), (std::vector<double>{fed.feed()[0], 250, 250, 254, 254}));
  ASSERT_EQ(kinds(fed), std::vector<std::string>{"feed"}) << "once";
  EXPECT_EQ(fed.notes[0], (Note{"feed", 2, "a feed move before the first F: taken at the feed of option first_feed"}));
  EXPECT_NE(nc_error("G93 G1 X1", "3-axis", feed).find("under G93 every block needs its own"), std::string::npos);
  EXPECT_NE(nc_error("G1 X1 F10\nX2 F0", "3-axis", feed).find("a feed move without F ["), std::string::npos);

  const Options motion{{"first_motion", std::string("G0")}};
  const Program moved = read_nc_text("G21 G80 G90\nX1 Y0 Z0\nG1 X2 F100\nX3", "3-axis", motion);
  EXPECT_EQ(moved.rapid(), (std::vector<std::uint8_t>{1, 0, 0}));
  ASSERT_EQ(moved.notes.size(), 1U);
  EXPECT_EQ(moved.notes[0],
            (Note{"motion", 2, "axis words before the first motion: taken as G0, by option first_motion"}));
  for (const char* name : {"first_feed", "first_motion", "arc_centres"})
    EXPECT_THROW(read_nc_text("G21 G0 X1", "3-axis", {{name, std::string("fast")}}), std::invalid_argument) << name;
}

TEST(RealPrograms, EachDrillingCycleAcceptsADwell) {
  for (const std::string cycle : {"G81", "G82", "G73 Q1", "G83 Q1", "G85", "G89"}) {
    const std::string header = "G21 G0 X0 Y0 Z5\n" + cycle;
    expect_same_moves(read_nc_text(header + " X1 Y1 Z-2 R1 F100 P500"), read_nc_text(header + " X1 Y1 Z-2 R1 F100"),
                      cycle);
    EXPECT_NE(nc_error(header + " X1 Y1 Z-2 R1 F100 P-1").find("P is negative"), std::string::npos) << cycle;
  }
}

TEST(RealPrograms, UnitsHaveTwoNames) {
  EXPECT_EQ(read_nc_text("G70 G0 X1").poses()[0].tip.x, 25.4);
  EXPECT_EQ(read_nc_text("G20 G0 X1\nG71 X1").poses()[1].tip.x, 1);
  EXPECT_EQ(read_nc_text("G70\nG1 X1 F2", "tcp", kSkip).feed()[0], 50.8);
  // A bolt circle on some controls: never taken for units.
  EXPECT_NE(nc_error("G70 Q100 X15 Z4 P1").find("turning cycles"), std::string::npos);
  EXPECT_EQ(nc_error("G70 I10 J0 L6"), "line 1: I has no meaning in this block [G70 I10 J0 L6]");
}

TEST(RealPrograms, AnMCodeOwnsNoAxisWord) {
  const Program p = read_nc_text("G21 G0 X0 Y0\nY20 M26\nX5 M97 P3", "tcp", kSkip);
  ASSERT_EQ(p.size(), 3U);
  EXPECT_EQ(p.poses()[2].tip, Vec3(5, 20, 0));
  EXPECT_EQ(kinds(p), (std::vector<std::string>{"skipped", "skipped"}));
}

TEST(RealPrograms, CoordinatesThatWereSkippedAreNotedAsSuch) {
  const Program p = read_nc_text("G21 G0 X0\nG60 X9\nG60 G0 X3", "tcp", kSkip);
  ASSERT_EQ(p.size(), 2U);
  EXPECT_EQ(kinds(p), (std::vector<std::string>{"coordinates", "skipped"}));
  EXPECT_EQ(p.notes[0].line, 2);
}

TEST(RealPrograms, ThePathOfTheCentreIsReadUnderCompensationOnRequest) {
  const std::string text = "G21 G0 X0 Y0 Z0\nG1 G41 D1 X10 F100\nG40 Y5";
  EXPECT_NE(nc_error(text).find("{'cutter_compensation': 'ignore'}"), std::string::npos);
  const Program p = read_nc_text(text, "tcp", {{"cutter_compensation", std::string("ignore")}});
  EXPECT_EQ(p.poses().back().tip, Vec3(10, 5, 0));
  EXPECT_EQ(kinds(p), std::vector<std::string>{"cutter compensation"});
}

TEST(RealPrograms, WordsThatMoveTheFollowingBlocksAreNeverSkipped) {
  for (const char* code : {"G68 X0 Y0 R30", "G68.2 X0 Y0 Z0 I0 J30 K0", "G53.1", "G16", "G12.1", "G51 X2", "G51.1 X0",
                           "G54.1 P3", "G154 P3"}) {
    for (const Options& options : {Options{}, kSkip}) {
      const std::string said = nc_error(std::string("G0 X0\n") + code + "\nX5", "tcp", options);
      EXPECT_NE(said.find("would move what follows"), said.npos) << said;
      EXPECT_EQ(said.find("skip"), said.npos) << said;
    }
  }
}

TEST(RealPrograms, CommentsMayHoldBrackets) {
  EXPECT_EQ(read_nc_text("G21 (a (b) c) G0 X1 (TOOL (5MM))").poses()[0].tip.x, 1);
  EXPECT_EQ(nc_error("G0 X1 (a (b)"), "line 1: unclosed comment [G0 X1 (a (b)]");
}

TEST(RealPrograms, AMotionInTheBlockOfAHomeHoldsAfterIt) {
  const Program p = read_nc_text("G21 G0 X1 Y2 Z3\nG0 G91 G28 Z0\nG90 X5\nZ4");
  EXPECT_TRUE(p.at_machine()[2]);
  EXPECT_EQ(p.poses().back().tip, Vec3(5, 2, 4));
  EXPECT_NE(nc_error("G0 X1\nG2 G28 X0").find("two codes that both use axis words"), std::string::npos);
}

TEST(RealPrograms, TheMotionFromBeforeACycleHoldsAfterIt) {
  const Program p = read_nc_text("G21 G0 X1 Y2 Z9\nG99 G81 X5 Z-3 R2 F100\nX7\nG80\nZ15");
  EXPECT_EQ(p.poses().back().tip, Vec3(7, 2, 15));
  EXPECT_TRUE(p.rapid().back());
  EXPECT_EQ(kinds(p), std::vector<std::string>{"motion"});
  EXPECT_EQ(read_nc_text("G21 G0 X1 Y2 Z9\nG82 X5 Z-3 R2 F100").size(), 5U) << "a dwell is only time";
  EXPECT_NE(nc_error("G80\nX1").find("line 2: axis words without a motion (G0, G1, G2, G3)"), std::string::npos);
}

TEST(RealPrograms, FunctionsOfTheMachineMoveNothing) {
  for (const char* code : {"M10", "M31", "M41", "M88", "M83"}) {
    const Program p = read_nc_text(std::string("G21 G0 X1 Y2 Z3\n") + code + "\nX5");
    EXPECT_EQ(p.size(), 2U);
    EXPECT_EQ(kinds(p), std::vector<std::string>{"user code"}) << code;
  }
  EXPECT_EQ(read_nc_text("G21 S500 M13\nG0 X1").spindle()[0], 500);
  EXPECT_EQ(read_nc_text("G21 S500 M14\nG0 X1").spindle()[0], -500);
}

}  // namespace
}  // namespace riffler::nc::real_programs_test
