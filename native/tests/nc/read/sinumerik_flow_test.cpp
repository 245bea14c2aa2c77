// Variables, expressions, control structures, jumps and subprograms of Sinumerik programs.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "riffler/nc/read/reader.hpp"
#include "support/nc_reading.hpp"

namespace riffler::nc::sinumerik_flow_test {
namespace {

const Options kMetric{{"units", std::string("mm")}, {"max_turns", 5000.0}};

Program read(const std::string& text) {
  return test::read_nc_text("G0 X0 Y0 Z0\n" + text, "sinumerik", kMetric);
}

/// The first line of `text` is line 2.
std::string error(const std::string& text) {
  return test::nc_error("G0 X0 Y0 Z0\n" + text, "sinumerik", kMetric);
}

/// The x of the rows behind the first.
std::vector<double> xs(const std::string& text) {
  std::vector<double> out;
  const Program p = read(text);
  for (std::size_t row = 1; row < p.size(); ++row) out.push_back(p.poses()[row].tip.x);
  return out;
}

double value(const std::string& expression) {
  return xs("X=" + expression).at(0);
}

TEST(SinumerikFlow, CalculatesAsTheControlDoes) {
  EXPECT_EQ(value("1+2*3-4/2"), 5);
  EXPECT_EQ(value("-(2+3)*-2"), 10);
  EXPECT_EQ(value("3/4"), 0.75);
  EXPECT_EQ(value("7 DIV 4.1"), 1);
  EXPECT_EQ(value("7 MOD 4"), 3);
  EXPECT_NEAR(value("SIN(30)+COS(60)+TAN(45)"), 2, 1e-12);
  EXPECT_NEAR(value("ASIN(0.5)+ACOS(0.5)"), 90, 1e-12);
  EXPECT_NEAR(value("ATAN2(30.5,80.1)"), 20.8455, 1e-4);
  EXPECT_NEAR(value("ATAN2(1,-1)"), 135, 1e-12);
  EXPECT_EQ(value("SQRT(POT(5)-9)"), 4);
  EXPECT_EQ(value("TRUNC(-2.7)+ROUND(2.5)+ABS(-1)+ROUNDUP(1.1)"), -2 + 3 + 1 + 2);
  EXPECT_EQ(value("MINVAL(3,2)+MAXVAL(3,2)+BOUND(1,5,9)"), 10);
  EXPECT_NEAR(value("LN(EXP(2))"), 2, 1e-12);
  EXPECT_EQ(value("1.5EX2"), 150);
  EXPECT_EQ(value("(1<2)+(2>=2)+(1<>1)+NOT(0)+(TRUE AND FALSE)+(1 OR 0)+(1 XOR 1)"), 4);
  EXPECT_EQ(value("0.1+0.2==0.3"), 1) << "within the control's tolerance";
  EXPECT_EQ(error("X=1/0"), "line 2: a calculation without a finite result [X=1/0]");
  EXPECT_EQ(error("X=SQRT(-1)"), "line 2: a calculation without a finite result [X=SQRT(-1)]");
  EXPECT_EQ(error("X=R7"), "line 2: R7 has no value: assign one before it is used (R7=...) [X=R7]");
  EXPECT_EQ(error("X=NAME"), "line 2: NAME is not defined: DEF REAL NAME=... before it is used [X=NAME]");
  EXPECT_EQ(error("X=FOO(1)").substr(0, 28), "line 2: unknown function FOO");
  EXPECT_EQ(error("IF 1<2 AND 3<4 GOTOF A\nA:").substr(0, 66),
            "line 2: a comparison combined with AND, OR or XOR without brackets");
}

TEST(SinumerikFlow, KeepsVariablesByTheirTypes) {
  EXPECT_EQ(xs("DEF REAL AA=2, BB\nDEF INT II=2.6\nDEF BOOL TT=5\nBB=AA+II\nX=BB+TT"), (std::vector<double>{6}));
  EXPECT_EQ(xs("R1=5 R02=R1*2\nX=R2\nR[R1+1]=7\nX=R6"), (std::vector<double>{10, 7}));
  EXPECT_EQ(xs("DEF REAL ARR[5]\nARR[2]=4\nX=ARR[2]+ARR[3]"), (std::vector<double>{4}));
  EXPECT_EQ(xs("DEF STRING[20] NAME=\"MILL\"\nT=NAME\nX1"), (std::vector<double>{1}));
  EXPECT_EQ(xs("R1=$AA_IM[X]\nR2=R1+1\nX1"), (std::vector<double>{1})) << "known to the control, and not used";
  EXPECT_EQ(error("R1=$AA_IM[X]\nX=R1").substr(0, 60), "line 3: the value of X is known only to the control (a syste");
  EXPECT_EQ(error("_B=1").substr(0, 26), "line 2: _B is not defined:");
}

TEST(SinumerikFlow, FollowsStructures) {
  EXPECT_EQ(xs("R1=2\nIF R1==2\nX1\nELSE\nX2\nENDIF\nIF R1<>2\nX3\nELSE\nX4\nENDIF"), (std::vector<double>{1, 4}));
  EXPECT_EQ(xs("DEF INT II\nFOR II=2 TO 4\nX=II\nENDFOR\nX9"), (std::vector<double>{2, 3, 4, 9}));
  EXPECT_EQ(xs("DEF INT II\nFOR II=2 TO 1\nX=II\nENDFOR\nX9"), (std::vector<double>{9}));
  EXPECT_EQ(xs("R1=0\nWHILE R1<3\nR1=R1+1\nX=R1\nENDWHILE"), (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(xs("R1=0\nREPEAT\nR1=R1+1\nX=R1\nUNTIL R1>=2"), (std::vector<double>{1, 2}));
  EXPECT_EQ(xs("R1=0\nLOOP\nR1=R1+1\nX=R1\nIF R1>2 GOTOF OUT\nENDLOOP\nOUT: X9"), (std::vector<double>{1, 2, 3, 9}));
  EXPECT_EQ(error("IF 1\nX1").substr(0, 40), "line 2: a control structure that is not ");
  EXPECT_EQ(error("ENDIF"), "line 2: ENDIF without what it ends [ENDIF]");
  EXPECT_EQ(error("LOOP\nENDLOOP"),
            "line 3: the program jumps more than 5000 times: it seems endless; option max_turns allows more [ENDLOOP]");
}

TEST(SinumerikFlow, JumpsToLabelsAndBlockNumbers) {
  EXPECT_EQ(xs("R1=0\nAGAIN: R1=R1+1 X=R1\nIF R1<3 GOTOB AGAIN\nGOTOF N100\nX99\nN100 X8"),
            (std::vector<double>{1, 2, 3, 8}));
  EXPECT_EQ(xs("GOTO END_1\nX1\nEND_1:\nX2"), (std::vector<double>{2}));
  EXPECT_EQ(xs("GOTOC NOWHERE\nX2"), (std::vector<double>{2}));
  EXPECT_EQ(xs("R1=2\nCASE R1 OF 1 GOTOF A 2 GOTOF B DEFAULT GOTOF C\nA: X1\nB: X2\nC: X3"),
            (std::vector<double>{2, 3}));
  EXPECT_EQ(xs("R1=7\nCASE(R1) OF 1 GOTOF A DEFAULT GOTOF C\nA: X1\nC: X3"), (std::vector<double>{3}));
  EXPECT_EQ(error("GOTOB LATER\nLATER: X1"), "line 2: there is no label LATER before this block [GOTOB LATER]");
}

TEST(SinumerikFlow, RepeatsParts) {
  EXPECT_EQ(xs("A: G91 X1\nX10\nREPEAT A P=2\nG90 X0"), (std::vector<double>{1, 11, 12, 22, 23, 33, 0}));
  EXPECT_EQ(xs("A: G91 X1\nB: X10\nX100\nREPEAT A B\nX1000"), (std::vector<double>{1, 11, 111, 112, 122, 1122}));
  EXPECT_EQ(xs("A: G91 X1\nX10\nREPEATB A P3"), (std::vector<double>{1, 11, 12, 13, 14}));
  EXPECT_EQ(xs("A: G91 X1\nENDLABEL: X10\nREPEAT A"), (std::vector<double>{1, 11, 12}));
  EXPECT_EQ(error("REPEAT NOWHERE"), "line 2: there is no label NOWHERE [REPEAT NOWHERE]");
}

TEST(SinumerikFlow, CallsSubprograms) {
  EXPECT_EQ(
      xs("HOLE(3,4)\nHOLE(,5) P2\nHOLE(1)\nM30\nPROC HOLE(REAL AT, INT BY=7)\nDEF REAL SUM\nSUM=AT+BY\nX=SUM\nRET"),
      (std::vector<double>{7, 5, 5, 8}));
  EXPECT_EQ(xs("L10\nL10 P2\nX9\nM30\n%_N_L10_SPF\nG91 X1\nG90\nM17"), (std::vector<double>{1, 2, 3, 9}));
  EXPECT_EQ(xs("R1=1\nCALL \"SUB\"\nX=R1\nM30\n%_N_SUB_SPF\nR1=5\nIF R1==5\nRET\nENDIF\nX99\nM30"),
            (std::vector<double>{5}));
  EXPECT_EQ(error("SUB(1,2)\nM30\nPROC SUB(REAL AA)\nRET"), "line 2: SUB takes 1 arguments, 2 are given [SUB(1,2)]");
  EXPECT_EQ(error("SUB\nM30\nPROC SUB\nSUB\nRET"), "line 5: subprograms are nested too deeply [SUB]");
  EXPECT_EQ(test::nc_error("PROC SUB(REAL A)\nG0 X=A", "sinumerik").substr(0, 42),
            "line 1: a subprogram with parameters: read");
}

TEST(SinumerikFlow, FindsSubprogramsNextToTheFile) {
  const auto folder = std::filesystem::temp_directory_path() / "riffler_sinumerik_flow";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "part.mpf") << "G0 X0 Y0 Z0\nstep(5)\nX9\nM30\n";
  std::ofstream(folder / "Step.SPF") << "PROC STEP(REAL BY)\nG91 X=BY\nG90\nX=NO_SUCH\n";
  std::string what;
  try {
    read_nc(folder / "part.mpf", {"sinumerik", kMetric});
  } catch (const FormatError& e) {
    what = e.what();
  }
  EXPECT_EQ(what, "Step.SPF, line 4: NO_SUCH is not defined: DEF REAL NO_SUCH=... before it is used [X=NO_SUCH]");
  std::ofstream(folder / "Step.SPF") << "PROC STEP(REAL BY)\nG91 X=BY\nG90\n";
  const Program p = read_nc(folder / "part.mpf", {"sinumerik", kMetric});
  EXPECT_EQ(p.poses()[1].tip.x, 5);
  EXPECT_EQ(p.line()[1], 2) << "of the main program";
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace riffler::nc::sinumerik_flow_test
