// Sinumerik programs: words, frames, machine positions, work offsets, tool axes, and what is refused.
#include "nc/read/sinumerik_reader.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "geom/math.hpp"
#include "riffler/nc/read/reader.hpp"
#include "riffler/nc/write/writer.hpp"
#include "riffler/tool/cutters.hpp"
#include "support/nc_reading.hpp"

namespace riffler::nc::sinumerik_reader_test {
namespace {

const Options kMetric{{"units", std::string("mm")}};

Program read(const std::string& text, Options options = kMetric, const std::string& machine = "sinumerik") {
  return test::read_nc_text(text, machine, std::move(options));
}

std::string error(const std::string& text, Options options = kMetric, const std::string& machine = "sinumerik") {
  return test::nc_error(text, machine, std::move(options));
}

std::vector<Vec3> tips(const Program& program) {
  std::vector<Vec3> out;
  for (const Pose& pose : program.poses()) out.push_back(pose.tip);
  return out;
}

std::vector<std::string> kinds(const Program& program) {
  std::vector<std::string> out;
  for (const Note& n : program.notes) out.push_back(n.kind);
  return out;
}

void expect_near(const Vec3& is, const Vec3& wanted, double most = 1e-9) {
  EXPECT_LE(glm::length(is - wanted), most) << is.x << ' ' << is.y << ' ' << is.z;
}

/// The place in the part of X=1 Y=2 Z=3 in the coordinates that `set` makes.
Vec3 place_after(const std::string& set) {
  const Program p = read("G0 X0 Y0 Z0\n" + set + "\nG0 X1 Y2 Z3\n");
  return p.poses().back().tip;
}

TEST(SinumerikReader, ReadsWordsInAllTheirForms) {
  const Program p = read(
      "%_N_PART_MPF\r\n;$PATH=/_N_MPF_DIR\r\n; a comment (with brackets)\r\nN10 G710 G17 G90 G94 G40 G54 FNORM ; "
      "modes\r\n"
      "MSG(\"ROUGH (1), \"\"A\"\"\")\nWORKPIECE(,\"\",,\"BOX\",64,0,50,-80)\nN20 T=\"BALL 6\" D1 M6\nN30 G0X1Y2.5Z30 "
      "S1=8000 M1=3\n"
      "N40 G1 Z=5 F=2*250 M8\nX=IC(10)\n/ Y99\nG91 X-1 Y=AC(0)\nG90 CYCLE832(0.01,_FINISH,1)\n:50 Z5.5EX1 FB=100\nZ1\n"
      "T7\nM6\nG0 Z50\nM30\nX99\n");
  EXPECT_EQ(
      tips(p),
      (std::vector<Vec3>{
          {1, 2.5, 30}, {1, 2.5, 5}, {11, 2.5, 5}, {11, 99, 5}, {10, 0, 5}, {10, 0, 55}, {10, 0, 1}, {10, 0, 50}}));
  EXPECT_EQ(p.feed(), (std::vector<double>{0, 500, 500, 500, 500, 100, 500, 0}));
  EXPECT_EQ(p.tool().front(), 8) << "after those that have a number";
  EXPECT_EQ(p.tool().back(), 7);
  EXPECT_EQ(p.spindle().front(), 8000);
  EXPECT_EQ(p.spindle().back(), 0) << "a tool change stops it";
  EXPECT_EQ(kinds(p), (std::vector<std::string>{"tool"}));
  EXPECT_EQ(read("/G0 X1 Y1 Z1\nG0 X2 Y2 Z2", {{"block_delete", true}}).size(), 1U);
}

TEST(SinumerikReader, TakesLengthsAndFeedsInTheirUnits) {
  EXPECT_EQ(read("G700 G1 X1 Y0 Z0 F2").poses()[0].tip.x, 25.4);
  EXPECT_EQ(read("G700 G1 X1 Y0 Z0 F2").feed()[0], 50.8);
  const Program g70 = read("G70 G1 X1 Y0 Z0 F2", {});
  EXPECT_EQ(g70.poses()[0].tip.x, 25.4);
  EXPECT_EQ(g70.feed()[0], 2) << "G70 is of lengths";
  EXPECT_EQ(kinds(g70), (std::vector<std::string>{"units"}));
  EXPECT_EQ(read("G70 G1 X1 Y0 Z0 F2", {{"units", std::string("inch")}}).feed()[0], 50.8);
  EXPECT_EQ(read("G71 G1 X1 Y0 Z0 F2", {{"units", std::string("inch")}}).poses()[0].tip.x, 1);
  EXPECT_EQ(kinds(read("G1 X1 Y0 Z0 F2", {})), (std::vector<std::string>{"units"}));
  EXPECT_EQ(read("G95 S100 G1 X1 Y0 Z0 F2").feed()[0], 200);
  EXPECT_EQ(read("G0 X0 Y0 Z0\nG93 G1 X10 F4").feed()[1], 40);
  EXPECT_EQ(error("G93 G1 X1 Y0 Z0 F1\nX2"), "line 2: a feed move without F: under G93 every block needs its own [X2]");
}

TEST(SinumerikReader, PutsFramesIntoTheirOrder) {
  expect_near(place_after("TRANS X10 Y20"), {11, 22, 3});
  expect_near(place_after("TRANS X10 Y20\nATRANS Z=5 X1"), {12, 22, 8});
  expect_near(place_after("TRANS X10 Y20\nTRANS Z5"), {1, 2, 8});
  expect_near(place_after("TRANS X10\nROT Z90"), {-2, 1, 3});
  expect_near(place_after("TRANS X10\nAROT Z90"), {8, 1, 3});
  expect_near(place_after("ROT Z90\nATRANS X10"), {-2, 11, 3});
  expect_near(place_after("ROT X90"), {1, -3, 2});
  expect_near(place_after("ROT Y90"), {3, 2, -1});
  expect_near(place_after("ROT RPL=90"), {-2, 1, 3});
  expect_near(place_after("G18\nROT RPL=90"), {3, 2, -1});
  // About Z, then about the new Y, then about the new X: the point is turned in the opposite order.
  expect_near(place_after("ROT X90 Z90"), place_after("ROT Z90\nAROT X90"));
  expect_near(place_after("ROT X90 Y90 Z90"), place_after("ROT Z90\nAROT Y90\nAROT X90"));
  for (const char* reset : {"TRANS", "ROT", "SCALE", "MIRROR", "TRANS X0 Y0 Z0"})
    expect_near(place_after(std::string("TRANS X10\nAROT X30\n") + reset), {1, 2, 3});
  EXPECT_EQ(error("TRANS C30"),
            "line 1: TRANS with a rotary axis is not read: have the post write its angles "
            "[TRANS C30]");
  EXPECT_EQ(error("SCALE X2"),
            "line 1: SCALE: scaling is not read: have the CAM system write the final moves [SCALE X2]");
  EXPECT_EQ(error("MIRROR X0", {{"unknown", std::string("skip")}}).substr(0, 16), "line 1: MIRROR: ");
  EXPECT_EQ(error("G0 X1 TRANS X1").substr(0, 36), "line 1: TRANS needs a block of its o");
}

TEST(SinumerikReader, MarksPositionsOfTheMachine) {
  const Program p = read(
      "G54 G90\nSUPA G0 Z=0 D0\nSUPA X=-365 Y=0 D1\nG0 X1 Y2 Z30\nG1 Z0 F100\nG53 G0 Z0 D0\nG0 D1 X5 Y5\nZ30\nG1 "
      "Z0\nG74 "
      "X1=0 Z1=0\nG0 X0 Y0\nZ5\nM30");
  EXPECT_EQ(p.at_machine(), (std::vector<std::uint8_t>{0, 0, 1, 1, 0, 0, 1, 1, 0}));
  EXPECT_EQ(kinds(p), (std::vector<std::string>{"machine position"}));
  EXPECT_EQ(tips(p)[4], Vec3(5, 5, 30));
  EXPECT_EQ(kinds(read("G0 X0 Y0 Z9\nG153 G1 Z0 F1\nX1")),
            (std::vector<std::string>{"machine position", "coordinates"}));
  EXPECT_EQ(kinds(read("G0 X0 Y0 D0\nZ9\nG1 Z0 F1")), (std::vector<std::string>{"tool length"}));
  EXPECT_EQ(error("G0 X0 Y0 Z9\nSUPA Z0\nG2 X9 CR=9 F9").substr(0, 36), "line 3: an arc while Z is at a machi");
  EXPECT_EQ(error("SUPA G2 X0 CR=5 F9").substr(0, 47), "line 1: an arc in coordinates of the machine: G");
  // A turned frame knows X and Y of the part only together.
  const Program turned = read("G0 X0 Y0 Z9\nROT Z45\nSUPA X0\nG0 X1 Y1\nZ9");
  EXPECT_EQ(turned.at_machine(), (std::vector<std::uint8_t>{0, 1, 1, 0}));
}

TEST(SinumerikReader, NotesUnknownWorkOffsets) {
  const Program p = read("G54 G0 X0 Y0 Z9\nG55 X1\nG505 X2\nG54 X3");
  ASSERT_EQ(kinds(p), (std::vector<std::string>{"work offset", "work offset"}));
  EXPECT_TRUE(p.notes[0].message.starts_with("G55: how far it is from G54 is not in the program"));
  EXPECT_TRUE(p.notes[1].message.starts_with("G505: "));
  EXPECT_EQ(kinds(read("G54 G500 G0 X0 Y0 Z9\nSUPA Z0\nG500\nX1 Y1 Z1")),
            (std::vector<std::string>{"machine position"}));
  EXPECT_EQ(kinds(read("G0 X0 Y0 Z9\nG54 X1")), (std::vector<std::string>{"work offset"}));
  EXPECT_EQ(error("G504").substr(0, 20), "line 1: unknown code");
}

TEST(SinumerikReader, HoldsRapidsUntilEveryAxisIsNamed) {
  const Program p = read("G0 X1\nY1\nZ5\nG1 Z0 F9");
  EXPECT_EQ(p.at_machine(), (std::vector<std::uint8_t>{1, 1, 0, 0}));
  EXPECT_EQ(kinds(read("G0 X1\nG1 Z0 F9")), (std::vector<std::string>{"start"}));
}

TEST(SinumerikReader, KeepsTheTipUnderTransformation) {
  const Program p =
      read("G0 X0 Y0 Z50\nTRAORI\nG1 X10 A30 C90 F500\nC=DC(350)\nC=ACP(80)\nA=IC(10)\nC=ACN(90)\nTRAFOOF\n");
  // The axis leans away from the direction that C has, by A.
  const double a = kPi / 6, last = -kPi / 18 - kPi / 2;
  expect_near(p.poses()[1].axis, {std::sin(a), 0, std::cos(a)});
  EXPECT_EQ(p.size(), 6U);
  expect_near(p.poses()[2].tip, {10, 0, 50});
  expect_near(p.poses()[2].axis, {std::sin(a) * std::cos(last), std::sin(a) * std::sin(last), std::cos(a)});
  const Program vectors = read("G0 X0 Y0 Z50\nTRAORI\nORIWKS\nG1 X10 A3=0 B3=3 C3=4 F500\nROT Z90\nX1 A3=0.6 C3=0.8");
  expect_near(vectors.poses()[1].axis, {0, 0.6, 0.8});
  expect_near(vectors.poses()[2].axis, {0, 0.6, 0.8}, 1e-12);
  EXPECT_EQ(error("TRAORI\nORIMKS\nG1 X1 A3=0 B3=0 C3=1 F1").substr(0, 30), "line 3: A3= B3= C3= under ORIM");
  EXPECT_EQ(error("G0 X0 Y0 Z0 A3=1").substr(0, 36), "line 1: A3= B3= C3= without TRAORI: ");
  EXPECT_EQ(error("G0 X0 A10\nG1 X1 F1").substr(0, 57), "line 2: a feed move with the rotary axes at A10 C0, witho");
  EXPECT_EQ(error("G0 X0 Y0 Z0\nG1 X1 A10 F1").substr(0, 62),
            "line 2: a feed move in which rotary axes turn without TRAORI: ");
  EXPECT_EQ(error("G0 B10"),
            "line 1: unknown letter B: the machine has no such axis; these have: sinumerik-bc [G0 B10]");
  EXPECT_EQ(error("G0 X1 W5", {{"unknown", std::string("skip")}}).substr(0, 50),
            "line 1: unknown letter W: second linear axes are n");
}

TEST(SinumerikReader, TurnsTheAxisAlongAGreatCircleOnCommand) {
  const std::string start = "G0 X0 Y0 Z0\nTRAORI\nG1 A45 C0 F100\n";
  EXPECT_EQ(read(start + "ORIVECT\nC90").via().size(), 0U);
  EXPECT_EQ(read(start + "ORIAXES\nC90").via().size(), 1U);
  EXPECT_EQ(read(start + "C90").via().size(), 1U);
  EXPECT_EQ(read(start + "ORIWKS\nC90").via().size(), 0U);
  EXPECT_EQ(read(start + "ORIWKS ORIAXES\nC90").via().size(), 1U);
}

TEST(SinumerikReader, SwivelsThePlane) {
  const double half = std::sqrt(0.5);
  const Program p = read(
      "G54 G0 X0 Y0 Z100\nCYCLE800(0,\"TC1\",200000,57,10,0,0,45,0,0,0,0,5,1,,1)\nG0 X0 Y0 Z10\nG1 Z0 F100\nX1\n"
      "CYCLE800()\nG0 A0 C0\nX0 Y0 Z100");
  const std::vector<std::uint8_t> away{0, 1, 0, 0, 0, 1, 1, 0};
  EXPECT_EQ(p.at_machine(), away);
  expect_near(p.poses()[3].tip, {10, -5 * half, 5 * half});
  expect_near(p.poses()[4].tip, {11, -5 * half, 5 * half});
  expect_near(p.poses()[4].axis, {0, -half, half});
  expect_near(p.poses()[7].tip, {0, 0, 100});
  const std::string after = "\nG0 X1 Y2 Z3\n";
  const auto place = [&](const std::string& call) { return read("G0 X0 Y0 Z0\n" + call + after).poses().back().tip; };
  // 39: about Z, then about the new X, then about the new Y.
  expect_near(place("CYCLE800(0,\"T\",0,39,0,0,0,30,40,0,0,0,0,1)"), place_after("ROT Z30\nAROT X40"));
  expect_near(place("CYCLE800(0,\"T\",0,54,0,0,0,30,40,0,0,0,0,1)"), place_after("ROT Y30\nAROT X40"));
  expect_near(place("CYCLE800(0,\"T\",0,57,0,0,0,10,20,30,0,0,0,1)"), place_after("ROT X10\nAROT Y20\nAROT Z30"));
  expect_near(place("CYCLE800(0,\"T\",0,57,1,0,0,90,0,0,0,0,0,1)\nCYCLE800(0,\"T\",1,57,0,2,0,0,0,90,0,0,0,1)"),
              place_after("TRANS X1\nAROT X90\nATRANS Y2\nAROT Z90"));
  expect_near(place("CYCLE800(0,\"T\",0,57,0,0,0,90,0,0,0,0,0,1)\nCYCLE800(0,\"T\",0,57,0,0,0,0,0,0,0,0,0,1)"),
              {1, 2, 3});
  EXPECT_EQ(read("G0 X0 Y0 Z9\nCYCLE800(0,\"T\",0,57,0,0,0,45,0,0,0,0,0,0)\nG0 A45\nG1 X0 Y0 Z0 F1").at_machine(),
            (std::vector<std::uint8_t>{0, 1, 0}))
      << "without a direction the axes turn only where the program turns them";
  EXPECT_EQ(error("CYCLE800(0,\"T\",0,57,0,0,0,45,0,0,0,0,0,0)\nG1 X0 Y0 Z0 F1").substr(0, 54),
            "line 2: a feed move with the rotary axes at A0 C0, whi");
  EXPECT_EQ(error("CYCLE800(0,\"T\",0,192,0,0,0,1,2,0,0,0,0,1)").substr(0, 40),
            "line 1: CYCLE800 with mode 192 is not re");
  EXPECT_EQ(error("TRAORI\nCYCLE800(0,\"T\",0,57,0,0,0,1,0,0,0,0,0,1)").substr(0, 30),
            "line 2: CYCLE800 under TRAORI:");
  EXPECT_EQ(error("G0 X0 Y0 Z0\nCYCLE800(0,\"T\",0,57,0,0,0,45,0,0,0,0,0,1)\nG0 A10 X0 Y0 Z0\nG1 X1 F1").substr(0, 53),
            "line 4: a feed move with the rotary axes at A10 C0, w");
  EXPECT_EQ(error("G0 X0 Y0 Z0\nCYCLE800(0,\"T\",0,57,0,0,0,45,0,0,0,0,0,1)", kMetric, "sinumerik-bc"), "no error");
}

TEST(SinumerikReader, NamesWhatItRefusesAndSkipsOnlyWhatMovesNothing) {
  const Options skip{{"unknown", std::string("skip")}, {"units", std::string("mm")}};
  EXPECT_EQ(error("G41 X1"),
            "line 1: cutter radius compensation (G41) is not read: have the CAM system write the path of the tool's "
            "centre, or, where that is what the program has, read it with options {'cutter_compensation': 'ignore'} "
            "[G41 X1]");
  EXPECT_EQ(kinds(read("G0 X0 Y0 Z0\nG41 G1 X1 F1\nG42 X2",
                       {{"cutter_compensation", std::string("ignore")}, {"units", std::string("mm")}})),
            (std::vector<std::string>{"cutter compensation"}));
  for (const char* text : {"POCKET4(10,0,2)", "CYCLE71(1)", "MCALL POCKET3(1)", "BSPLINE", "TRACYL(40)", "DEF FRAME A",
                           "$P_PFRAME=CTRANS(X,5)", "WHENEVER $A_IN[1] DO OVR=0", "SETAL(66021)", "G291", "G33 Z1 K1",
                           "G110 X0 Y0", "G1 RND=5", "G1 AP=30 RP=5", "POS[X]=5", "TCARR=1", "G58 X1"}) {
    EXPECT_NE(error(text), "no error") << text;
    EXPECT_NE(error(text, skip), "no error") << text;
    EXPECT_EQ(error(text, skip).find("unknown"), std::string::npos) << error(text, skip);
  }
  EXPECT_EQ(error("G0 X0 Y0 Z5\nHEAD_CLEAN\nX1").substr(0, 53),
            "line 2: unknown statement or subprogram HEAD_CLEAN: c");
  const Program p = read("G0 X0 Y0 Z5\nHEAD_CLEAN\nX1\nX1 Y1 Z1", skip);
  EXPECT_EQ(p.at_machine(), (std::vector<std::uint8_t>{0, 1, 1, 0})) << "where the tool is then is not known";
  EXPECT_EQ(kinds(p), (std::vector<std::string>{"coordinates", "machine position"}));
  EXPECT_EQ(error("X1"), "line 1: axis words without a motion (G0, G1, G2, G3) [X1]");
  EXPECT_EQ(error("G1 X1"), "line 1: a feed move without F [G1 X1]");
  EXPECT_EQ(error("(comment)").substr(0, 24), "line 1: unexpected '(': ");
  EXPECT_EQ(error("G0 X1 X2"), "line 1: X twice in one block [G0 X1 X2]");
  EXPECT_EQ(error("G0 X2e7").substr(0, 8), "line 1: ");
  EXPECT_EQ(error("G0 X2000000"), "line 1: X is out of range [G0 X2000000]");
  EXPECT_EQ(kinds(read("M90\nG0 X0 Y0 Z0 M90")), (std::vector<std::string>{"user code"}));
}

TEST(SinumerikReader, NamesTheMachinesThatReadIt) {
  EXPECT_EQ(test::nc_error("%_N_A_MPF\nG0 X=1"),
            "line 2: expected a number after X [G0 X=1]: the file begins as a Sinumerik program; machines that read "
            "them: sinumerik, sinumerik-bc");
  EXPECT_EQ(test::nc_error("%_N_A_MPF\nG0 X1"), "no error");
  EXPECT_EQ(test::nc_error("%_N_A_MPF\nG0 X1", "heidenhain").substr(0, 31), "line 1: a Sinumerik program (%_");
  EXPECT_EQ(test::nc_error("BEGIN PGM A MM\n", "sinumerik").substr(0, 40), "line 1: a Heidenhain conversational prog");
  EXPECT_THROW(read("G0 X1", {{"tcp", false}}), std::invalid_argument);
}

TEST(SinumerikReader, ReadsBackWrittenCode) {
  for (const bool arcs : {false, true}) {
    Program program;
    for (int k = 0; k <= 40; ++k) {
      const double t = k * 0.04;
      const Vec3 axis = arcs ? Vec3(0, 0, 1) : glm::normalize(Vec3(0.3 * std::sin(t), 0.2 * std::cos(t), 1));
      program.append({{{20 * std::cos(t), 20 * std::sin(t), -1}, axis}, k == 0 ? 0.0 : 500.0, 9000, 1, k + 1, k == 0});
    }
    program.tools.emplace(1, cutters::ball(6, 30));
    WriteOptions writing;
    writing.post = "sinumerik", writing.options = {{"arcs", arcs}};
    const std::string text = to_nc(program, writing);
    EXPECT_NE(text.find("TRAORI"), text.npos);
    EXPECT_EQ(text.find(" I") != text.npos, arcs);
    const Program back = read(text);
    for (const Pose& pose : program.poses()) {
      double nearest = 1e9;
      for (const Pose& is : back.poses())
        nearest = std::min(nearest, glm::length(is.tip - pose.tip) + glm::length(is.axis - pose.axis));
      EXPECT_LT(nearest, arcs ? 0.5 : 2e-5);
    }
  }
}

}  // namespace
}  // namespace riffler::nc::sinumerik_reader_test
