#include "nc/read/apt_reader.hpp"
#include "geom/math.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "riffler/tool/cutters.hpp"
#include "support/nc_reading.hpp"

namespace riffler::nc::apt_reader_test {
namespace {

Program read(const std::string& text, Options options = {}) {
  return parse_apt(text, "p.apt", {"apt", std::move(options)});
}

TEST(AptReader, ReadsMovesToolsFeedsAndSpeeds) {
  const Program p = read(
      "PARTNO/A PART, WITH $ AND /\r\nPPRINT hello $\r\n$$ a comment\r\nUNITS / MM\nMULTAX/ON\n"
      "CUTTER/ 10.0, 5.0, 0.0, 5.0, 0, 0, 60\nLOADTL/3,ADJUST,1\nSPINDL/ 8000,RPM,CLW\nCOOLNT/ON\nRAPID\n"
      "GOTO/ 1.0,2.0, $ comes\n  30.0, 0.0,0.0,1.0\n"
      "FEDRAT/ 500.0,MMPM\ngoto / 1,2,3 $$ the tool's axis stays\nGOTO/4,5,6,0.6,0,.8\nGODLTA/0,0,-1\nGODLTA/10\n"
      "LOADTL/4\nCUTTER/8,1,3,1,0,0,40\nSPINDL/OFF\nRAPID\nFEDRAT/MMPM,250\nGOTO/0,0,50,0,0,1\nGOTO/"
      "0,0,0\nEND\nFINI\nGARBAGE");
  ASSERT_EQ(p.size(), 7U);
  EXPECT_EQ(p.poses()[0].tip, Vec3(1, 2, 30));
  EXPECT_EQ(p.poses()[1].tip, Vec3(1, 2, 3));
  EXPECT_EQ(p.poses()[2].tip, Vec3(4, 5, 6));
  EXPECT_LT(glm::length(p.poses()[2].axis - Vec3(0.6, 0, 0.8)), 1e-15);
  EXPECT_EQ(p.poses()[3].tip, Vec3(4, 5, 5));
  EXPECT_LT(glm::length(p.poses()[4].tip - Vec3(10, 5, 13)), 1e-14) << "one number goes along the axis";
  EXPECT_EQ(p.rapid(), (std::vector<std::uint8_t>{1, 0, 0, 0, 0, 1, 0}));
  EXPECT_EQ(p.feed(), (std::vector<double>{0, 500, 500, 500, 500, 0, 250}));
  EXPECT_EQ(p.tool(), (std::vector<std::int32_t>{3, 3, 3, 3, 3, 4, 4}));
  EXPECT_EQ(p.spindle(), (std::vector<double>{8000, 8000, 8000, 8000, 8000, 0, 0}));
  EXPECT_EQ(p.line(), (std::vector<std::int32_t>{11, 14, 15, 16, 17, 23, 24}));
  EXPECT_EQ(p.tools.at(3).parameters(), cutters::ball(10, 60).parameters());
  EXPECT_EQ(p.tools.at(4).parameters(), cutters::fillet(8, 1, 40).parameters());
}

TEST(AptReader, ConvertsInches) {
  const Program p =
      read("UNITS/INCHES\nCUTTER/1,0,.5,0,0,0,2\nFEDRAT/10\nFROM/1,2,3\nGOTO/2,2,3\nFEDRAT/100,MMPM\nGOTO/0,0,0");
  EXPECT_EQ(p.poses()[0].tip, 25.4 * Vec3(1, 2, 3));
  EXPECT_EQ(p.feed(), (std::vector<double>{0, 254, 100}));
  EXPECT_EQ(p.tools.at(1).parameters(), cutters::flat(25.4, 50.8).parameters());
  EXPECT_EQ(p.tool(), (std::vector<std::int32_t>{1, 1, 1})) << "a file that loads no tools";
}

TEST(AptReader, CirclesGoCounterClockwiseAboutTheirAxis) {
  const Program p =
      read("FEDRAT/100\nGOTO/10,0,1\nCIRCLE/0,0,1,0,0,1,10\nGOTO/0,10,3\nCIRCLE/0,0,3,0,0,-1,10\nGOTO/10,0,3");
  double way = 0;
  for (std::size_t k = 1; k < p.size(); ++k) {
    const Vec3 &a = p.poses()[k - 1].tip, &b = p.poses()[k].tip;
    way += glm::length(b - a);
    EXPECT_NEAR(std::hypot(b.x, b.y), 10, 1e-12);
    EXPECT_GE(std::hypot(a.x + b.x, a.y + b.y) / 2, 10 - 0.002);
    EXPECT_GT(b.x + b.y, 9.99) << "both quarters lie in the first quadrant";
  }
  EXPECT_NEAR(way, std::hypot(5 * kPi, 2) + 5 * kPi, 0.01);
  EXPECT_EQ(p.poses().back().tip, Vec3(10, 0, 3));
}

TEST(AptReader, ReadsCyclesAsTheMotionTheyMean) {
  const Program p = read(
      "PARTNO/1\nUNIT/MM\nCUTTER/12.,0,6.,0,0,0,63.\nLOAD/TOOL,12\nCSI_SET_FLUTE_LENGTH/4.\nSELECT/TOOL,11\nTRNTYP/"
      "WORLD,0,0,0\nCSYS/1.,0,0,0,0,1.,0,0,0,0,1.,0\nRAPID/\nGOTO/10,20,25\nCYCLE/INIT\nCYCLE/DRILL,FEDTO,5,MMPM,300,"
      "RAPTO,3,RTRCTO,27.5,DWELL,0\nGOTO/10,20,-2.5\nCYCLE/OFF\nCYCLE/"
      "DEEP2,FEDTO,8,1STPECK,5,SUBPECK,2,MMPM,400,RAPTO,3\n"
      "GOTO/30,20,0\nCYCLE/TAP,FEDTO,4,IPM,10,RAPTO,2\nGOTO/0,0,0,0,0.6,0.8\nCYCLE/OFF\nRAPID\nGOTO/0,0,50\nFINI");
  const std::vector<double> z{25, 25, 0.5, -7.5, 25, 3, -5, 3, -4.746, -7, 3, -6.746, -8, 3, 1.6, -3.2, 1.6, 50};
  ASSERT_EQ(p.size(), z.size());
  for (std::size_t k = 0; k < z.size(); ++k) EXPECT_NEAR(p.poses()[k].tip.z, z[k], 1e-12) << k;
  EXPECT_EQ(p.feed()[3], 300);
  EXPECT_EQ(p.feed()[6], 400);
  EXPECT_EQ(p.feed()[15], 254);
  EXPECT_EQ(p.feed()[16], 254) << "a tap is fed out";
  EXPECT_EQ(p.poses()[15].tip, Vec3(0, -2.4, -3.2)) << "along the tool's axis";
  EXPECT_EQ(p.tool()[0], 12);
  EXPECT_EQ(p.tools.at(12).parameters(), cutters::flat(12, 63).parameters());
  EXPECT_TRUE(p.notes.empty());
}

TEST(AptReader, KeepsSystemsApart) {
  // The second system's x is the first one's y, its origin 100 further on.
  const Program p = read(
      "MSYS/10,0,0,1,0,0,0,1,0\nTLDATA/MILL,40.0,1.0,50.0,0.0,0.0\nFEDRAT/MMPM,100\nGOTO/1,2,3\n"
      "MSYS/110,0,5,0,1,0,-1,0,0\nGOTO/1,2,3,1,0,0\nGODLTA/1,0,0\nMSYS/10,0,0,1,0,0,0,1,0\nGODLTA/0,0,1");
  EXPECT_EQ(p.poses()[0].tip, Vec3(1, 2, 3));
  EXPECT_EQ(p.poses()[1].tip, Vec3(98, 1, 8));
  EXPECT_EQ(p.poses()[1].axis, Vec3(0, 1, 0));
  EXPECT_EQ(p.poses()[2].tip, Vec3(98, 2, 8));
  EXPECT_EQ(p.poses()[3].tip, Vec3(98, 2, 9)) << "from where the tool was";
  EXPECT_EQ(p.tools.at(1).parameters(), cutters::fillet(40, 1, 50).parameters());
}

TEST(AptReader, ReadsCreosCommentsAndCirclesWithoutARadius) {
  const Program p = read(
      "$$*  Pro/CLfile  Version 11.0\n$$-> MFGNO / MFG0006\nPARTNO / MFG0006\n$$-> CSYS / 1.0, 0.0, 0.0, 0.0,  $\n"
      "0.0, 1.0, 0.0, 0.0, $\n0.0, 0.0, 1.0, 0.0\nUNITS / MM\nFEDRAT / 10.0, MMPM\nGOTO / 10.0, 0.0, 0.0\n"
      "CIRCLE / 0, 0, 0, 0, 0, 1\nGOTO / 0, 10, 0\nCIRCLE/0,0,0,0,0,1,10,CLOCKWISE\nGOTO/10,0,0\n$$-> END /\nFINI ");
  double turned = 0;
  for (std::size_t k = 1; k < p.size(); ++k) {
    const Vec3 &a = p.poses()[k - 1].tip, &b = p.poses()[k].tip;
    turned += std::abs(std::atan2(a.x * b.y - a.y * b.x, a.x * b.x + a.y * b.y));
    EXPECT_GT(b.x + b.y, 9.99);
  }
  EXPECT_NEAR(turned, kPi, 1e-9);
  const Program left = read("CUTCOM/LEFT\nGOTO/1,2,3\nCUTCOM/OFF", {{"cutter_compensation", std::string("ignore")}});
  ASSERT_EQ(left.notes.size(), 1U);
  EXPECT_EQ(left.notes[0].kind, "cutter compensation");
}

TEST(AptReader, RefusesUnknownStatements) {
  const std::pair<const char*, const char*> cases[] = {
      {"GOTO/1,2", "GOTO takes 3 to 6 numbers, not 2 [GOTO/1,2]"},
      {"GOTO/1,2,3,4", "GOTO takes 3 or 6 numbers [GOTO/1,2,3,4]"},
      {"GOTO/1,2,X", "GOTO: expected a number, not 'X' [GOTO/1,2,X]"},
      {"GOTO/1,2,nan", "GOTO: expected a number, not 'NAN' [GOTO/1,2,nan]"},
      {"GOTO/1,2,3,0,0,2", "a direction that is not a unit vector [GOTO/1,2,3,0,0,2]"},
      {"GOTO/1,2,1e300", "a coordinate is out of range [GOTO/1,2,1e300]"},
      {"GOTO/0,0,0\nGOTO/1,0,0", "a feed move without FEDRAT [GOTO/1,0,0]"},
      {"FEDRAT/0", "FEDRAT is out of range [FEDRAT/0]"},
      {"FEDRAT/5,PARSEC", "FEDRAT: unknown word PARSEC [FEDRAT/5,PARSEC]"},
      {"SPINDL/5,SFM", "SPINDL: unknown word SFM [SPINDL/5,SFM]"},
      {"UNITS/FEET", "UNITS: expected MM or INCHES, not FEET [UNITS/FEET]"},
      {"CYCLE/DRILL,5",
       "CYCLE with numbers alone: only one post processor knows their meaning; have the CAM system write FEDTO, RAPTO "
       "and RTRCTO, or the moves [CYCLE/DRILL,5]"},
      {"CYCLE/MILL,FEDTO,5",
       "CYCLE/MILL is not read: DRILL, FACE, DEEP, TAP, REAM and BORE are; have the CAM system write its moves "
       "[CYCLE/MILL,FEDTO,5]"},
      {"CYCLE/DRILL,RAPTO,5", "CYCLE needs FEDTO, its depth below the point [CYCLE/DRILL,RAPTO,5]"},
      {"CYCLE/DEEP,FEDTO,5", "CYCLE/DEEP needs the depth of a peck, INCR [CYCLE/DEEP,FEDTO,5]"},
      {"CYCLE/DEEP,FEDTO,5,INCR,1e-9", "CYCLE: too many pecks [CYCLE/DEEP,FEDTO,5,INCR,1e-9]"},
      {"CYCLE/DRILL,FEDTO", "CYCLE: FEDTO without a number [CYCLE/DRILL,FEDTO]"},
      {"ROTABL/90,AAXIS",
       "ROTABL is not read: it would move the tool or what follows; have the CAM system write GOTOs [ROTABL/90,AAXIS]"},
      {"CSYS/1,0,0,0,0,1,0,0,0,0,1,0\nCSYS/1,0,0,5,0,1,0,0,0,0,1,0",
       "CSYS of another system than before: where the one lies in the other is not read; write a program for each "
       "[CSYS/1,0,0,5,0,1,0,0,0,0,1,0]"},
      {"MSYS/0,0,0,1,0,0,0.8,0.6,0", "MSYS whose axes are not at right angles [MSYS/0,0,0,1,0,0,0.8,0.6,0]"},
      {"CUTCOM/LEFT",
       "cutter radius compensation (CUTCOM) is for the control that the file is posted to: cutter location data are "
       "points of the tool's centre as a rule; where these are, read them with options {'cutter_compensation': "
       "'ignore'} [CUTCOM/LEFT]"},
      {"LOADTL/1.5", "LOADTL needs the tool's number [LOADTL/1.5]"},
      {"THREAD/1", "unknown statement THREAD: correct it, or read with options {'unknown': 'skip'} [THREAD/1]"},
      {"FEDRAT/1\nGOTO/0,0,0\nCIRCLE/5,0,0,0,0,1,4\nGOTO/10,0,0",
       "the circle's radius is not the distance of its start [GOTO/10,0,0]"},
      {"CIRCLE/5,0,0,0,0,1,4", "CIRCLE without the GOTO of its end"},
      {"GOTO/1,2,$", "the file ends within a statement that $ continues [GOTO/1,2,$]"},
      {"GOTO/1,2,\xC3", "a character outside ASCII, or none that is printed [GOTO/1,2,?]"},
      {"LOADTL/1\nCUTTER/10,0,5,0,0,0,50\nGOTO/0,0,0\nCUTTER/8,0,4,0,0,0,50\nRAPID\nGOTO/0,0,0",
       "tool 1 has two shapes [GOTO/0,0,0]"},
  };
  for (const auto& [text, what] : cases) {
    std::string error = "no error";
    int line = 2;
    for (const char* c = text; *c; ++c) line += *c == '\n';
    try {
      read(std::string("$$\n") + text);
    } catch (const FormatError& e) {
      error = e.what();
    }
    EXPECT_EQ(error, "p.apt, line " + std::to_string(line) + ": " + what);
  }
  const Program p = read("THREAD/1\nGOTO/0,0,0\nINSERT M100", {{"unknown", std::string("skip")}});
  EXPECT_EQ(p.provenance[1].second, "line 1: THREAD; line 3: INSERT M100");
}

std::string apt_error(const std::string& text) {
  try {
    read(text);
  } catch (const FormatError& e) {
    return e.what();
  }
  return "no error";
}

TEST(AptReader, TakesACircleSeveralTimes) {
  const std::string circle = "FROM/10,0,5\nFEDRAT/100\nGOTO/10,0,0\nCIRCLE/0,0,0,0,0,1,10,0.06,0.5,8,0,TIMES,3\n";
  const Program p = read(circle + "GOTO/10,0,0\n");
  double way = 0;
  for (std::size_t k = 2; k < p.size(); ++k) way += glm::length(p.poses()[k].tip - p.poses()[k - 1].tip);
  EXPECT_NEAR(way, 3 * 20 * 3.14159265358979, 0.2);
  EXPECT_NE(apt_error(circle + "GOTO/10,0,-3\n").find("several turns along its axis"), std::string::npos);
  EXPECT_NE(apt_error("FROM/1,0,0\nCIRCLE/0,0,0,0,0,1,1,TIMES,x\n").find("TIMES needs a whole number"),
            std::string::npos);
}

TEST(AptReader, DrillsDeepToThePointItself) {
  const Program p = read("FROM/0,0,50\nCYCLE/DRILL,DEEP,RAPTO,3,FEDTO,0,MMPM,250\nGOTO/5,5,-8\nCYCLE/OFF\n");
  std::vector<double> heights;
  for (const Pose& pose : p.poses()) heights.push_back(pose.tip.z);
  EXPECT_EQ(heights, (std::vector<double>{50, -5, -8, -5}));
}

}  // namespace
}  // namespace riffler::nc::apt_reader_test
