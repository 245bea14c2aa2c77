// Heidenhain's conversational programs: lines, tools, feeds, labels, parameters, tilted planes, and what is refused.
#include "nc/read/heidenhain_reader.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "riffler/nc/read/reader.hpp"
#include "riffler/nc/write/writer.hpp"
#include "riffler/tool/cutters.hpp"
#include "support/nc_reading.hpp"

namespace riffler::nc::heidenhain_reader_test {
namespace {

Program read(const std::string& blocks, Options options = {}, const std::string& machine = "heidenhain") {
  return test::read_nc_text("0 BEGIN PGM T MM\n" + blocks + "\nEND PGM T MM\n", machine, std::move(options));
}

/// The error for the blocks, whose first is line 2.
std::string error(const std::string& blocks, Options options = {}, const std::string& machine = "heidenhain") {
  return test::nc_error("0 BEGIN PGM T MM\n" + blocks + "\nEND PGM T MM\n", machine, std::move(options));
}

std::vector<Vec3> tips(const Program& program) {
  std::vector<Vec3> out;
  for (const Pose& pose : program.poses()) out.push_back(pose.tip);
  return out;
}

void expect_near(const Vec3& is, const Vec3& wanted, double most, const std::string& what = "") {
  EXPECT_LE(glm::length(is - wanted), most) << what << ": " << is.x << ' ' << is.y << ' ' << is.z;
}

std::vector<std::string> kinds(const Program& program) {
  std::vector<std::string> out;
  for (const Note& n : program.notes) out.push_back(n.kind);
  return out;
}

TEST(HeidenhainReader, ReadsLinesToolsFeedsAndSpeeds) {
  const Program p = test::read_nc_text(
      "\xEF\xBB\xBF; a comment before\r\n0 BEGIN PGM PART 7 MM\r\n1 BLK FORM 0.1 Z X-10 Y-10 Z-20\r\n"
      "2 BLK FORM 0.2 X+10 Y+10 Z+0\r\n3 * - ROUGHING\r\n4 TOOL DEF 3\r\n5 TOOL CALL 3 Z S8000,5 F350 DL+0 DR+0\r\n"
      "6 L X+1 Y+2,5 Z+30 R0 FMAX M3\r\n7 l z5 fauto ; down\r\n8 L IX+10 F500 M8\r\n9 L X-1.5\r\n"
      "10 TOOL CALL S4000\r\n11 L Y+0\r\n12 TOOL CALL \"BALL 6\" Z S900\r\n13 L Z+50 F MAX M13\r\n14 L Z+1 F 200 M5\r\n"
      "15 L Z+2\r\n16 M30\r\n17 L X+99\r\n18 END PGM PART 7 MM\r\nGARBAGE",
      "heidenhain");
  EXPECT_EQ(tips(p), (std::vector<Vec3>{{1, 2.5, 30},
                                        {1, 2.5, 5},
                                        {11, 2.5, 5},
                                        {-1.5, 2.5, 5},
                                        {-1.5, 0, 5},
                                        {-1.5, 0, 50},
                                        {-1.5, 0, 1},
                                        {-1.5, 0, 2}}));
  EXPECT_EQ(p.rapid(), (std::vector<std::uint8_t>{1, 0, 0, 0, 0, 1, 0, 0}));
  EXPECT_EQ(p.feed(), (std::vector<double>{0, 350, 500, 500, 500, 0, 200, 200}));
  EXPECT_EQ(p.spindle(), (std::vector<double>{8000.5, 8000.5, 8000.5, 8000.5, 4000, 900, 900, 0}));
  EXPECT_EQ(p.tool(), (std::vector<std::int32_t>{3, 3, 3, 3, 3, 4, 4, 4})) << "a name gets a number of its own";
  EXPECT_EQ(p.line(), (std::vector<std::int32_t>{8, 9, 10, 11, 13, 15, 16, 17}));
  EXPECT_EQ(kinds(p), (std::vector<std::string>{"tool"}));
}

TEST(HeidenhainReader, ConvertsInches) {
  const Program p = test::read_nc_text(
      "BEGIN PGM A INCH\nTOOL CALL 1 Z S1000\nL X1 Y2 Z3 FMAX\nQ1=.5\nL IZ-Q1 F200\nFN 0: Q206 = 10\nEND PGM A INCH",
      "heidenhain");
  EXPECT_EQ(p.poses()[0].tip, 25.4 * Vec3(1, 2, 3));
  expect_near(p.poses()[1].tip, 25.4 * Vec3(1, 2, 2.5), 1e-12);
  EXPECT_NEAR(p.feed()[1], 20 * 25.4, 1e-9) << "F counts tenths of inches";
}

Program five_axes() {
  Program p;
  const auto add = [&](const Vec3& tip, const Vec3& axis, double feed, double spindle, int tool, bool rapid) {
    p.append({{tip, glm::normalize(axis)}, feed, spindle, tool, 0, rapid});
  };
  add({0, 0, 50}, {0, 0, 1}, 0, 8000, 1, true);
  add({10, -5, 2}, {0.1, 0.2, 1}, 0, 8000, 1, true);
  for (int k = 0; k <= 20; ++k)
    add({10 + k, -5 + 0.3 * k, 2 - 0.05 * k}, {0.1 + 0.05 * k, 0.2 - 0.04 * k, 1}, 600 + k, 8000, 1, false);
  add({30, 1, 1}, {1, -0.5, 0.2}, 620, 8000, 1, false);
  add({30, 1, 80}, {1, -0.5, 0.2}, 0, 8000, 1, true);
  add({0, 0, 80}, {0, -0.3, 1}, 0, -9000, 2, true);
  add({0, 0, 1}, {0, -0.3, 1}, 120, -9000, 2, false);
  add({0, 9, 1}, {0, -0.3, 1}, 240, 0, 2, false);
  p.tools.emplace(1, cutters::ball(6, 30));
  return p;
}

/// Every row of `p` is among those of `q`, in their order, with what it says of feed, spindle and tool.
void expect_holds(const Program& p, const Program& q, const std::string& what) {
  std::size_t at = 0;
  for (std::size_t row = 0; row < p.size(); ++row, ++at) {
    const Pose& wanted = p.poses()[row];
    while (at < q.size() &&
           (glm::length(q.poses()[at].tip - wanted.tip) > 1e-5 || glm::length(q.poses()[at].axis - wanted.axis) > 2e-7))
      ++at;
    ASSERT_LT(at, q.size()) << what << ", row " << row;
    EXPECT_EQ(q.tool()[at], p.tool()[row]) << what << ", row " << row;
    EXPECT_EQ(q.spindle()[at], p.spindle()[row]) << what << ", row " << row;
    EXPECT_EQ(q.rapid()[at], p.rapid()[row]) << what << ", row " << row;
    EXPECT_NEAR(q.feed()[at], p.feed()[row], 1e-3) << what << ", row " << row;
  }
}

TEST(HeidenhainReader, ReadsBackWhatThePostWrites) {
  const Program p = five_axes();
  for (const std::string machine : {"heidenhain", "heidenhain-bc"})
    for (const bool vectors : {false, true})
      for (const std::string coolant : {"off", "mist"}) {
        WriteOptions options{
            machine, 0.01, 0.00175, {{"vectors", vectors}, {"coolant", coolant}, {"safe_start", false}}};
        const std::string text = to_nc(p, options);
        const Program q = test::read_nc_text(text, machine, options.options);
        expect_holds(p, q, machine + (vectors ? " by vectors" : " by angles"));
        EXPECT_TRUE(q.notes.empty());
        // What was read is written again unchanged: nothing is lost.
        Program again = q;
        again.tools = p.tools, again.provenance = p.provenance;
        expect_holds(q, test::read_nc_text(to_nc(again, options), machine, options.options), machine + ", again");
      }
}

TEST(HeidenhainReader, RecognisesTheMachineOfTheCode) {
  Program p;
  p.append({{{0, 0, 5}, {0, 0.6, 0.8}}, 0, 0, 1, 0, true});
  const std::string text = to_nc(p, {"heidenhain-bc", 0.01, 0.00175, {}});
  EXPECT_EQ(test::nc_error(text, "heidenhain").substr(0, 57),
            "line 2: written for machine heidenhain-bc, not heidenhain");
  EXPECT_EQ(
      test::nc_error(text, "tcp"),
      "line 1: a Heidenhain conversational program (BEGIN PGM), and the machine's control reads another language; "
      "machines that read heidenhain: heidenhain, heidenhain-bc");
  EXPECT_EQ(test::nc_error(text, "apt").substr(0, 40), "line 1: a Heidenhain conversational prog");
  const std::string other = test::nc_error("G0 X1\nM2\n", "heidenhain");
  EXPECT_TRUE(other.starts_with("line 1: not a Heidenhain conversational program")) << other;
  EXPECT_NE(other.find("machines that read rs274: tcp, tcp-bc, linuxcnc-xyzac"), other.npos) << other;
  EXPECT_THROW(read("L X1 FMAX", {{"tcp", false}}), std::invalid_argument);
  EXPECT_THROW(read("L X1 FMAX", {{"subroutines", std::string("x")}}), std::invalid_argument);
}

TEST(HeidenhainReader, LabelsAreCalledAndRepeated) {
  const Program p = read(
      "L X0 Y0 Z0 FMAX\nCALL LBL 1\nCALL LBL \"ROW\"\nLBL 7\nL IX+1 F100\nCALL LBL 7 REP 2/2\nL Z9 FMAX\nM30\n"
      "LBL 1\nL IY+1 F100\nLBL 0\nLBL \"ROW\"\nCALL LBL 1\nLBL 9\nL IZ+1 F100\nCALL LBL 9 REP1\nLBL 0");
  EXPECT_EQ(tips(p),
            (std::vector<Vec3>{
                {0, 0, 0}, {0, 1, 0}, {0, 2, 0}, {0, 2, 1}, {0, 2, 2}, {1, 2, 2}, {2, 2, 2}, {3, 2, 2}, {3, 2, 9}}));
  EXPECT_EQ(tips(read("LBL 1\nL IX1 FMAX\nCALL LBL 1 REP 0")).size(), 1U);
  EXPECT_EQ(error("CALL LBL 5"), "line 2: there is no LBL 5 [CALL LBL 5]");
  EXPECT_EQ(error("LBL 1\nLBL 1"), "line 3: LBL 1 is set twice [LBL 1]");
  EXPECT_EQ(error("LBL 1\nFN 9: IF +1 EQU +1 GOTO LBL 1", {{"max_turns", 20.0}}).substr(0, 50),
            "line 3: the program jumps more than 20 times: it s");
  EXPECT_EQ(error("LBL 1\nCALL LBL 1\nLBL 0").substr(0, 45), "line 3: subprograms are nested too deeply [CA");
  EXPECT_EQ(error("CALL PGM TNC:\\A.H").substr(0, 48), "line 2: a call of another program is not read: p");
}

TEST(HeidenhainReader, CalculatesWithParameters) {
  const auto x = [](const std::string& before, const std::string& value) {
    return read(before + "\nL X" + value + " FMAX").poses().back().tip.x;
  };
  EXPECT_EQ(x("FN 0: Q1 = +5", "Q1"), 5);
  EXPECT_EQ(x("FN0:Q1=-2,5", "-Q1"), 2.5);
  EXPECT_EQ(x("Q1=3\nFN 1: Q2 = +Q1 + -5", "+Q2"), -2);
  EXPECT_EQ(x("FN 2: Q2 = +10 - +4\nFN 3: Q3 = +Q2 * +3\nFN 4: Q4 = +Q3 DIV +4", "Q4"), 4.5);
  EXPECT_NEAR(x("FN 5: Q1 = SQRT 2", "Q1"), std::sqrt(2), 1e-15);
  EXPECT_NEAR(x("FN 6: Q1 = SIN +30", "Q1"), 0.5, 1e-15);
  EXPECT_NEAR(x("FN 8: Q1 = +3 LEN +4", "Q1"), 5, 1e-15);
  EXPECT_NEAR(x("FN 13: Q1 = -1 ANG +1", "Q1"), 315, 1e-12);
  EXPECT_EQ(x("Q1 = 2 + 3 * ( 4 - 1 ) ^ 2", "Q1"), 29);
  EXPECT_EQ(x("QL1 = ABS (1 - 8) / 2\nQR5 = INT QL1 + FRAC 1.25 + SGN -3", "QR5"), 2.25);
  EXPECT_NEAR(x("Q1 = ATAN 1 + ACOS 0 + NEG LN EXP 2", "Q1"), 133, 1e-12);
  EXPECT_EQ(x("Q1 = 1\nLBL 1\nQ1 = Q1 * 2\nFN 12: IF +Q1 LT +100 GOTO LBL 1", "Q1"), 128);
  EXPECT_EQ(x("Q1 = 1\nFN 11: IF +Q1 GT +1 GOTO LBL 1\nFN 10: IF +Q1 NE +1 GOTO LBL 1\nQ1 = 7\nLBL 1", "Q1"), 7);
  EXPECT_EQ(error("L XQ5 FMAX"), "line 2: Q5 has no value: assign one before it is used (FN 0: Q5 = ...) [L XQ5 FMAX]");
  EXPECT_EQ(error("FN 18: SYSREAD Q5 = ID270 NR1 IDX1\nQ6 = Q5 + 1\nL XQ6 FMAX").substr(0, 60),
            "line 4: the value of X is known only to the control (FN 18, ");
  EXPECT_EQ(error("Q1 = 1 / 0").substr(0, 46), "line 2: a calculation without a finite result ");
  EXPECT_EQ(error("Q1 = ( 1 + 2"), "line 2: a bracket that is not closed [Q1 = ( 1 + 2]");
  EXPECT_EQ(error("FN 14: ERROR=1042").substr(0, 24), "line 2: FN 14 stops the ");
  EXPECT_EQ(error("FN 17: SYSWRITE ID50 NR1 IDX1 = +0").substr(0, 24), "line 2: FN 17 is not rea");
}

TEST(HeidenhainReader, DatumShiftsAndRotationsMoveTheFollowingBlocks) {
  const Program p = read(
      "L X1 Y0 Z0 FMAX\nCYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X+10\nCYCL DEF 7.2 IY+5\nL X1 Y0 FMAX\nL IX+1 FMAX\n"
      "CYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT+90\nL X1 Y0 FMAX\nCYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT 0\n"
      "CYCL DEF 7.0\nCYCL DEF 7.1 X0\nCYCL DEF 7.2 Y0\nCYCL DEF 7.3 Z0\nL IX0 IY1 FMAX\n"
      "CYCL DEF 247 DATUM SETTING ~\n  Q339=+4 ;DATUM NUMBER\nL X0 FMAX");
  EXPECT_EQ(p.poses()[1].tip, Vec3(11, 5, 0));
  EXPECT_EQ(p.poses()[2].tip, Vec3(12, 5, 0));
  expect_near(p.poses()[3].tip, {10, 6, 0}, 1e-12);
  expect_near(p.poses()[4].tip, {10, 7, 0}, 1e-12);
  expect_near(p.poses()[5].tip, {0, 7, 0}, 1e-12);
  EXPECT_EQ(kinds(p), (std::vector<std::string>{"work offset"}));
  EXPECT_EQ(read("TRANS DATUM AXIS X+5 IY+2\nL X1 Y1 Z0 FMAX\nTRANS DATUM RESET\nL X1 FMAX").poses()[0].tip,
            Vec3(6, 3, 0));
  EXPECT_EQ(read("TRANS DATUM AXIS X+5\nL X1 Y1 Z0 FMAX\nTRANS DATUM RESET\nL X1 FMAX").poses()[1].tip, Vec3(1, 1, 0));
  EXPECT_EQ(error("CYCL DEF 7.0 DATUM\nCYCL DEF 7.1 #3").substr(0, 50),
            "line 3: cycle 7 with a line of the datum table is ");
  EXPECT_EQ(error("CYCL DEF 8.0 MIRROR\nCYCL DEF 8.1 X").substr(0, 40), "line 3: cycle 8 (mirroring) is not read:");
}

/// R of the manual, by matrices written out: about the fixed X, then Y, then Z.
Vec3 turned_by(const Vec3& v, double a, double b, double c) {
  const double k = std::acos(-1.0) / 180;
  Vec3 p(v.x, std::cos(a * k) * v.y - std::sin(a * k) * v.z, std::sin(a * k) * v.y + std::cos(a * k) * v.z);
  p = {std::cos(b * k) * p.x + std::sin(b * k) * p.z, p.y, -std::sin(b * k) * p.x + std::cos(b * k) * p.z};
  return {std::cos(c * k) * p.x - std::sin(c * k) * p.y, std::sin(c * k) * p.x + std::cos(c * k) * p.y, p.z};
}

TEST(HeidenhainReader, TiltedPlanesFollowTheirAngles) {
  struct Case {
    const char* plane;
    double a, b, c;
  };
  for (const auto& [plane, a, b, c] : {Case{"SPATIAL SPA+90 SPB+0 SPC+180", 90, 0, 180},
                                       {"SPATIAL SPA20 SPB0 SPC55", 20, 0, 55},
                                       {"SPATIAL SPA-90 SPB+0 SPC-90", -90, 0, -90},
                                       {"SPATIAL SPA+0 SPB+0 SPC+20", 0, 0, 20},
                                       {"SPATIAL SPA+12.5 SPB-33 SPC+170", 12.5, -33, 170},
                                       {"VECTOR BX1 BY0 BZ0 NX0 NY-1 NZ0", 90, 0, 0}})
    for (const std::string machine : {"heidenhain", "heidenhain-bc"})
      for (const std::string how :
           {"TURN FMAX SEQ+ TABLE ROT", "MOVE DIST 5 F2000 SEQ- COORD ROT", "STAY SEQ- TABLE ROT"}) {
        const std::string letter = machine == "heidenhain" ? "A+Q120" : "B+Q121";
        const Program p =
            read("CYCL DEF 7.0 D\nCYCL DEF 7.1 X+1\nCYCL DEF 7.2 Y+2\nCYCL DEF 7.3 Z+3\nL X0 Y0 Z9 FMAX\nPLANE " +
                     std::string(plane) + " " + how + "\nL " + letter +
                     " C+Q122 R0 FMAX M126\nL X+5 Y-6 Z+70 FMAX\nL Z-2 F300\nL IY+1\nPLANE RESET STAY\n",
                 {}, machine);
        const std::string what = machine + ' ' + plane + ' ' + how;
        const std::size_t last = p.size() - 1;
        const Vec3 normal = turned_by({0, 0, 1}, a, b, c);
        expect_near(p.poses()[last - 2].tip, Vec3(1, 2, 3) + turned_by({5, -6, 70}, a, b, c), 1e-9, what);
        expect_near(p.poses()[last - 1].tip, Vec3(1, 2, 3) + turned_by({5, -6, -2}, a, b, c), 1e-9, what);
        expect_near(p.poses()[last].tip, Vec3(1, 2, 3) + turned_by({5, -5, -2}, a, b, c), 1e-9, what);
        for (std::size_t row = last - 2; row <= last; ++row) expect_near(p.poses()[row].axis, normal, 1e-9, what);
      }
}

TEST(HeidenhainReader, TakesTheAnglesOfAxesThatThePostPrints) {
  // A face of a block towards +Y, as a post with positions of the axes writes it.
  const std::string begin = "PLANE SPATIAL SPA+90 SPB+0 SPC+180 STAY\n", end = " FMAX\nL X0 Y0 Z10 FMAX\nL Z-1 F100";
  for (const std::string angles : {"L A-90 C0", "L A+90 C+180", "L A+90 C-180", "L A+Q120 C+Q122"}) {
    const Program p = read(begin + angles + end);
    expect_near(p.poses().back().tip, {0, -1, 0}, 1e-9, angles);
    expect_near(p.poses().back().axis, {0, 1, 0}, 1e-9, angles);
  }
  EXPECT_EQ(error(begin + "L A-80 C0" + end).substr(0, 67),
            "line 5: the rotary axes stand at A-80 C0, the tilted plane needs A-");
  EXPECT_EQ(error(begin + "L X0 Y0 Z10 FMAX\nL Z-1 F100").substr(0, 44),
            "line 4: the rotary axes stand at A0 C0, the ");
  EXPECT_EQ(error("L A30 FMAX\nL X0 Y0 Z0 F100").substr(0, 64),
            "line 3: a feed move with the rotary axes at A30 C0, without M128");
  EXPECT_EQ(error("L X0 Y0 Z0 FMAX\nL X5 A30 F100").substr(0, 48), "line 3: a feed move in which rotary axes turn wi");
  EXPECT_EQ(error("PLANE SPATIAL SPA+30 SPB+0 SPC+0 TURN FMAX", {}, "heidenhain-bc"), "no error");
  EXPECT_EQ(error("PLANE PROJECTED PROPR+24 PROMIN+24 ROT+30").substr(0, 24), "line 2: PLANE is read wi");
  EXPECT_EQ(error("CYCL DEF 19.0 PLANE\nCYCL DEF 19.1 A+30 C+10").substr(0, 33), "line 3: cycle 19 without all of A");
  const Program old = read("CYCL DEF 19.0 WORKING PLANE\nCYCL DEF 19.1 A+90 B+0 C+180\n" + ("L A+Q120 C+Q122" + end));
  expect_near(old.poses().back().tip, {0, -1, 0}, 1e-9);
}

TEST(HeidenhainReader, TheControlKeepsTheTip) {
  const Program p = read(
      "L X0 Y0 Z50 FMAX\nM128 F1000\nL X1 Y2 Z3 A30 C90 F500\nL A45\nL Z4\nM129\nL A0 C0 FMAX\nL X0 Y0 Z0 FMAX\n"
      "FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS\nL A10 FMAX\nL A0 FMAX\nFUNCTION RESET TCPM\nFUNCTION TCPM F CONT "
      "AXIS SPAT "
      "PATHCTRL "
      "VECTOR\nL A0 B+30 C0 F100\nL X5");
  const double s = std::sqrt(0.5);
  EXPECT_EQ(p.poses()[1].tip, Vec3(1, 2, 3));
  expect_near(p.poses()[1].axis, {0.5, 0, std::sqrt(0.75)}, 1e-12);
  expect_near(p.poses()[2].axis, {s, 0, s}, 1e-12);
  expect_near(p.poses()[3].axis, {s, 0, s}, 1e-12);
  EXPECT_EQ(p.feed()[1], 500) << "the F of M128 is none of its block";
  const Pose last = p.poses().back();
  expect_near(last.axis, {0.5, 0, std::sqrt(0.75)}, 1e-12, "angles in space");
  EXPECT_EQ(last.tip.x, 5);
  EXPECT_EQ(kinds(p), (std::vector<std::string>{"machine position"}));
  const Program v =
      read("M128\nL X0 Y0 Z0 FMAX\nLN X1 Y0 Z0 NX0 NY0 NZ1 TX+0.6 TY+0 TZ+0.8 F500\nL Z5\nLN X2 NX0 NY0 NZ1\n");
  expect_near(v.poses()[1].axis, {0.6, 0, 0.8}, 1e-15);
  EXPECT_EQ(v.poses()[2].axis, v.poses()[1].axis) << "kept to the bit";
  EXPECT_EQ(v.poses()[3].tip, Vec3(2, 0, 5));
  EXPECT_EQ(error("LN X1 TX0.6 TY0 TZ0.8 F1").substr(0, 38), "line 2: LN with TX TY TZ without M128:");
  EXPECT_EQ(error("M128\nLN X1 TX0.6 TY0 TZ0.9 F1").substr(0, 40), "line 3: TX TY TZ are not a unit vector [");
  EXPECT_EQ(error("L B3 FMAX").substr(0, 57), "line 2: unknown letter B: the machine has no such axis; r");
}

TEST(HeidenhainReader, FollowsTheAxesWhereTheirToleranceIsGiven) {
  const std::string moves = "L X0 Y0 Z0 A0 C0 FMAX\nL X10 A40 C90 F100";
  EXPECT_EQ(read("M128\n" + moves).size(), 2U);
  const Program fine = read("M128\n" + moves, {{"axis_tolerance", 0.001}});
  ASSERT_GT(fine.size(), 10U);
  for (std::size_t row = 1; row < fine.size(); ++row) {
    const double t = static_cast<double>(row) / static_cast<double>(fine.size() - 1), k = std::acos(-1.0) / 180;
    const double a = 40 * t * k, c = 90 * t * k;
    expect_near(fine.poses()[row].axis, {std::sin(c) * std::sin(a), -std::cos(c) * std::sin(a), std::cos(a)}, 1e-12);
    expect_near(fine.poses()[row].tip, {10 * t, 0, 0}, 1e-12);
  }
  EXPECT_EQ(read("FUNCTION TCPM F TCP AXIS POS PATHCTRL VECTOR\n" + moves, {{"axis_tolerance", 0.001}}).size(), 2U)
      << "PATHCTRL VECTOR is the great circle";
}

TEST(HeidenhainReader, PositionsOfTheMachineKeepThePose) {
  const Program p = read(
      "M140 MB MAX\nL X5 Y6 R0 FMAX M3\nL Z20 FMAX\nL Z-1 F300\nL Z0 R0 FMAX M91\nL X7 FMAX\nL Y0 FMAX\nL Z15 FMAX\n"
      "L M140 MB MAX\nL X1 FMAX\nM140 MB 5\nL Z3 FMAX\nM140 MB+10 F500");
  EXPECT_EQ(tips(p), (std::vector<Vec3>{{5, 6, 20},
                                        {5, 6, -1},
                                        {5, 6, -1},
                                        {5, 6, -1},
                                        {5, 6, -1},
                                        {7, 0, 15},
                                        {7, 0, 15},
                                        {7, 0, 15},
                                        {7, 0, 15},
                                        {1, 0, 3},
                                        {1, 0, 13}}))
      << "until X Y Z are known again";
  EXPECT_EQ(p.feed().back(), 500);
  EXPECT_EQ(kinds(p), (std::vector<std::string>{"machine position"}));
  // Off the tilted plane a coordinate of the machine is none of the part, also when the plane holds again.
  const Program off = read(
      "PLANE SPATIAL SPA+90 SPB+0 SPC+0 TURN FMAX\nL X0 Y0 Z9 FMAX\nPLANE RESET STAY\nL Z50 FMAX\nPLANE SPATIAL SPA+90 "
      "SPB+0 SPC+0 TURN FMAX\nL X3 FMAX\nL Y4 FMAX\nL Z5 FMAX");
  for (std::size_t row = 1; row < 4; ++row) expect_near(off.poses()[row].tip, {0, -9, 0}, 1e-12);
  expect_near(off.poses()[4].tip, {3, -5, 4}, 1e-12);
  const Program q = read("L X0 Y0 Z5 FMAX\nL Z-100 FMAX M92\nL X10 F100");
  EXPECT_EQ(q.poses().back().tip, Vec3(0, 0, 5));
  EXPECT_EQ(kinds(q), (std::vector<std::string>{"machine position", "coordinates"}));
  EXPECT_EQ(kinds(read("L X0 F100")), (std::vector<std::string>{"start"}));
}

TEST(HeidenhainReader, SkipsBlocksThatMoveNothing) {
  const std::string plain = "L X0 Y0 Z5 FMAX\nL X10 F100";
  for (const std::string quiet : {"M8",
                                  "M25\nM55 M57",
                                  "CYCL DEF 32.0 TOLERANCE\nCYCL DEF 32.1 T0.01\nCYCL DEF 32.2 HSC-MODE:0 TA0.5",
                                  "CYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL 2",
                                  "CYCLE DEF 9.0 DWELL TIME\nCYCLE DEF 9.1 5",
                                  "STOP M6",
                                  "STOP",
                                  "FN 15: PRINT Q1/Q2",
                                  "FUNCTION MODE MILL",
                                  "CYCL DEF 392 ATC ~\n  Q240=0 ;MODE ~\n  Q241=1",
                                  "CYCL DEF 13.0 ORIENTATION\nCYCL DEF 13.1 ANGLE 180",
                                  "QS1 = \"NAME\"",
                                  "M126",
                                  "M127",
                                  "L R0",
                                  "L M9",
                                  "M120 LA 20",
                                  "M103 F0.5",
                                  "M94 C",
                                  "CYCL DEF 11.0 SCALING\nCYCL DEF 11.1 SCL 1",
                                  "FUNCTION RESET TCPM",
                                  "PLANE RESET STAY",
                                  "(A NOTE)",
                                  "L M8 (COOLANT)",
                                  "CYCL DEF 252 POCKET ~\n Q215=0",
                                  "; text ~\n over two lines",
                                  "BLK FORM CYLINDER Z R50 L10",
                                  "CYCL DEF 19.0 PLANE\nCYCL DEF 19.1"})
    EXPECT_EQ(tips(read(quiet + "\n" + plain)), tips(read(plain))) << quiet;
  EXPECT_EQ(tips(read("/L X7 FMAX\n" + plain, {{"block_delete", true}})), tips(read(plain)));
  EXPECT_EQ(tips(read("/5 L X7 Y7 Z7 FMAX\n" + plain)).size(), 3U) << "the control skips them only on request";
  const Program skipped = read("CYCL DEF 301 OWN ~\n Q1=2\nOWNWORD 5\n" + plain, {{"unknown", std::string("skip")}});
  EXPECT_EQ(tips(skipped), tips(read(plain)));
  EXPECT_EQ(kinds(skipped), (std::vector<std::string>{"skipped", "skipped"}));
  EXPECT_EQ(skipped.provenance.back().second, "line 2: CYCL DEF 301; line 4: OWNWORD");
}

TEST(HeidenhainReader, RefusesUnknownBlocks) {
  const std::pair<std::string, std::string> cases[] = {
      {"L X1", "line 2: a feed move without F [L X1]"},
      {"L X1 X2 FMAX", "line 2: word X twice [L X1 X2 FMAX]"},
      {"L X FMAX", "line 2: X without a number [L X FMAX]"},
      {"L X1 Q FMAX", "line 2: unexpected 'Q' [L X1 Q FMAX]"},
      {"L X1 F-5", "line 2: unexpected '-5' [L X1 F-5]"},
      {"L X1 FZ0.1", "line 2: a feed per tooth (FZ)"},
      {"L X1 W5 FMAX", "line 2: the axis W is not read"},
      {"L X1 RL F100", "line 2: cutter radius compensation (RL): where the program has the contour"},
      {"L X1e9 FMAX", "line 2: unexpected 'e9'"},
      {"L X9999999 FMAX", "line 2: X is out of range"},
      {"APPR LT X1 Y2 LEN5 R5 RL F100", "line 2: APPR is not read"},
      {"TCH PROBE 427", "line 2: probing (TCH PROBE) cannot be simulated"},
      {"PATTERN DEF", "line 2: PATTERN is not read"},
      {"HELLO", "line 2: unknown statement HELLO: correct it"},
      {"TOOL CALL 1 X S100", "line 2: the tool axis X is not read"},
      {"TOOL CALL 1.5 Z", "line 2: a tool with an index"},
      {"L X1 FMAX M130", "line 2: M130 (positions in the untilted system)"},
      {"FUNCTION TURNDATA SPIN", "line 2: this FUNCTION is not read"},
      {"CYCL DEF 221 PATTERN", "line 2: cycle 221 is not read"},
      {"CYCL DEF 301 OWN", "line 2: cycle 301 is the machine builder's own"},
      {"CYCL DEF 12.0 PGM CALL", "line 2: cycle 12 calls another program"},
      {"L X1 FMAX ~", "line 2: unexpected 'END'"},
      {"L X0 Y0 FMAX\nCYCL CALL", "line 3: a call without a cycle"},
  };
  for (const auto& [blocks, wanted] : cases) {
    const std::string is = error(blocks);
    EXPECT_TRUE(is.starts_with(wanted)) << blocks << ": " << is;
  }
  for (const std::string moves :
       {"APPR LT X1", "TCH PROBE 427", "SEL PGM \"A\"", "FC DR+ R5", "PLANE POINTS", "CYCL DEF 221 X"})
    EXPECT_NE(error(moves, {{"unknown", std::string("skip")}}), "no error") << moves;
  const Program p = read("L X1 Y0 Z0 RL F100\nL X2 R0", {{"cutter_compensation", std::string("ignore")}});
  EXPECT_EQ(kinds(p), (std::vector<std::string>{"cutter compensation"}));
}

}  // namespace
}  // namespace riffler::nc::heidenhain_reader_test
