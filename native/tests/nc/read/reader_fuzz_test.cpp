// Mutated programs: for any text the reader gives a valid program or one FormatError.
#include <gtest/gtest.h>

#include <cmath>
#include <iterator>
#include <random>
#include <string>

#include "riffler/base/error.hpp"
#include "riffler/nc/read/reader.hpp"
#include "riffler/nc/write/writer.hpp"
#include "support/effort.hpp"

namespace riffler::nc::reader_fuzz_test {
namespace {

const std::string kSeeds[] = {
    "0 BEGIN PGM A MM\n1 BLK FORM 0.1 Z X0 Y0 Z-9\nTOOL DEF 3 L+0 R+4\nTOOL CALL 3 Z S900 F80 DL+0\nL X1 Y2,5 Z30 R0 "
    "FMAX M3\nL "
    "IZ-9 F100 M8\nCC X+0 Y+0\nC X2,5 Y1 DR-\nCP IPA+400 IZ-1 DR+\nLP PR+3 PA45\nCT X9 Y8\nCR X5 Y5 R+9 DR+\nL "
    "X20\nRND "
    "R1\nL Y20\nCHF 2\nL X0\n* - MORE\nQ1 = 2 * ( 3 + SIN 30 ) ^ 2\nFN 9: IF +Q1 EQU +5 GOTO LBL 3\nLBL 1\nL "
    "IX+Q1\nCALL LBL "
    "1 REP 2/2\nLBL 3\nCALL LBL \"S\"\nL Z0 R0 FMAX M91\nM140 MB MAX\nL X0 Y0 Z9 FMAX\nM30\nLBL \"S\"\nFN 18: SYSREAD "
    "Q9 = "
    "ID1\nL IY+1\nLBL 0\nEND PGM A MM\n",
    "BEGIN PGM B INCH\nTOOL CALL \"D5\" Z S500\nCYCL DEF 247 DATUM ~\n Q339=1 ;N\nCYCL DEF 7.0 D\nCYCL DEF 7.1 "
    "X1\nCYCL DEF 7.2 "
    "IY1\nPLANE SPATIAL SPA+90 SPB0 SPC180 TURN FMAX SEQ- TABLE ROT\nL X0 Y0 Z3 FMAX M13\nCYCL DEF 200 DRILL ~\n "
    "Q200=.1 ~\n "
    "Q201=-1 ~\n Q206=9 ~\n Q202=.4 ~\n Q203=0 ~\n Q204=1 ~\n Q334=.3 ~\n Q335=1\nL X1 FMAX M99\nCYCL CALL\nPLANE "
    "RESET "
    "STAY\nL A+Q120 C0 FMAX M126\nM128 F100\nL X0 Y0 Z1 A10 C20 F90\nLN X1 Y0 Z1 TX.6 TY0 TZ.8\nM129\nFUNCTION TCPM F "
    "TCP AXIS "
    "SPAT PATHCTRL AXIS\nL A1 B2\nFUNCTION RESET TCPM\nCYCL DEF 32.0 T\nCYCL DEF 32.1 T.01\nCYCL DEF 10.0 R\nCYCL DEF "
    "10.1 "
    "ROT+5\nSTOP\nEND PGM B INCH\n",
    "%_N_SEED_MPF\n"
    ";$PATH=/_N_MPF_DIR\n"
    "N10 DEF REAL _HOME=-10, ARR[3]\n"
    "N20 G17 G710 G94 G90 G40 G54 FNORM G642 ADIS=0.1\n"
    "SUPA G0 Z=_HOME D0\n"
    "T=\"BALL 6\" D1 M6\n"
    "MSG(\"ROUGH\")\n"
    "G0X1Y2Z30S8000M3\n"
    "CYCLE832(0.01,_FINISH,1)\n"
    "R1=1\n"
    "G1 Z=5-R1 F=100*2\n"
    "R1=2 ARR[1]=R1+SIN(30)\n"
    "TRANS X10 Y=ARR[1]\n"
    "AROT X30 Z=R1\n"
    "G2 I=AC(4) J3 TURN=2\n"
    "G3 X=IC(2) Y=IC(2) CR=-4\n"
    "CIP X1 Y1 Z1 I1=2 J1=3 K1=1\n"
    "CT X9 Y9\n"
    "G3 I-10 AR=120\n"
    "G18 G2 X=IC(1) Z=IC(1) CR=2\n"
    "G17\n"
    "ROT\n"
    "TRANS\n"
    "G55 G1 X=IC(5) Y=AC(3)\n"
    "CYCLE800(1,\"TC1\",200000,57,0,0,0,30,0,0,0,0,5,1,,1)\n"
    "G0 X1 Y1 Z1\n"
    "CYCLE800()\n"
    "G0 A0 C0\n"
    "TRAORI\n"
    "G1 X1 Y1 Z1 A10 C=DC(350) F90\n"
    "ORIWKS ORIVECT\n"
    "X2 A3=0.1 B3=0.2 C3=1\n"
    "TRAFOOF\n"
    "G74 X1=0 Z1=0\n"
    "G4 F2\n"
    "M30\n",
    "G0 X0 Y0 Z0 F100\n"
    "DEF INT II, NN=3\n"
    "DEF STRING[10] NAME=\"T1\"\n"
    "T=NAME M6\n"
    "FOR II=1 TO NN\n"
    "IF (II>1) AND NOT(II==3)\n"
    "X=II\n"
    "ELSE\n"
    "Y=II*2\n"
    "ENDIF\n"
    "ENDFOR\n"
    "R5=0\n"
    "WHILE R5<4\n"
    "R5=R5+1\n"
    "IF R5==3 GOTOF OUT\n"
    "ENDWHILE\n"
    "OUT: Z1\n"
    "REPEAT\n"
    "R5=R5-1\n"
    "UNTIL R5<=0\n"
    "PART: G91 X1\n"
    "BEND: Y1\n"
    "ENDLABEL:\n"
    "G90\n"
    "REPEAT PART BEND P=2\n"
    "REPEAT PART P2\n"
    "REPEATB PART P=3\n"
    "CASE R5 OF 0 GOTOF A1 1 GOTOF B1 DEFAULT GOTOF C1\n"
    "A1: HOLE(1,,2) P2\n"
    "B1: L10 P2\n"
    "C1: CALL \"HOLE\"\n"
    "LOOP\n"
    "GOTOF N90\n"
    "ENDLOOP\n"
    "N90 MCALL CYCLE83(20,0,2,-10,,,4,1,,,0.5,1,,1)\n"
    "HOLES1(0,0,30,5,10,3)\n"
    "HOLES2(0,0,10,0,0,4)\n"
    "MCALL CYCLE84(20,0,3,-10,,,3,8,,0,500)\n"
    "X1\n"
    "MCALL\n"
    "CYCLE86(20,0,2,-10,,0,3,-0.2,0.1,0.5,45)\n"
    "R1=$AA_IM[X]\n"
    "/ X5\n"
    "M30\n"
    "PROC HOLE(REAL AT, INT BY=7, BOOL TT)\n"
    "X=AT+BY\n"
    "RET\n"
    "%_N_L10_SPF\n"
    "G91 X1\n"
    "G90\n"
    "M17\n",
    "%\nO1 (SEED)\nN1 G21 G90 G94 G17 G40 G49 G80 G54\nT1 M6\nS8000 M3\nG43.4 H1\nG0 X10.00000 Y-20.5 Z30 A10.5 "
    "C-120.25\n"
    "G1 Z5 F600\nX20 A20\nX30.125 Y2 C-100\nG93 X40 F2.5\nX41 C-90 F3\nG94 G0 Z30 A0\nM5\nG49\nM30\n%\n",
    "G20 G91\nG1 X1 F10 ; inch\nG2 X1 Y1 I1 J0\nG3 X-1 Y-1 R1\nG18 G2 X1 Z1 K1\nG19 G3 Y1 Z1 R-1\nG17 G2 I.5 "
    "Z.1\nG90.1\n"
    "G90 G3 X2 Y2 I2 J1\nG4 P1\nG64 P.01 Q.02\nM7 M8\nM9 M1\nM2\n",
    "#1=2 #<a b>=[#1*3]\no1 sub\nG0 X#1 Y[#2-1]\no2 if [#1 GT 0]\no1 call [#1-1] [2]\no2 endif\no1 endsub [#1]\no1 "
    "call "
    "[3] [4]\n#1=0\no3 while [#1 LT 5]\n#1=[#1+1]\no4 if [#1 EQ 3]\no3 continue\no4 elseif [#1 MOD 2]\no3 break\no4 "
    "else\no4 endif\nG0 X#1\no3 endwhile\no5 repeat [3]\nG91 X1\no5 endrepeat\no6 do\n#1=[#1-1]\no6 while [#1 GT 0]\n"
    "X[SIN[30]+ATAN[1]/[2]-EXISTS[#<a>]]\nM98 P9\nM2\nO9\nG0 Y1\nM99\n",
    "G0 X1 Y1\nG92 X0 A3\nG10 L2 P2 X5 Y6 R30\nG55 X1\nG52 Y3\nG53 G0 Z4\nG28.1\nG28 X2\nG10 L20 P0 X7\nG92.2\nG92.3\n"
    "G43.1 Z5\nF100\nG98 G83 X1 Y2 Z-5 R2 Q1.5 L2\nX3\nG99 G73 X1 Z-5 R2 Q3\nG18 G81 X3 Z2 Y-3 R1\nG17 G80\nG1 X1\nG5 "
    "X5 "
    "Y5 I1 J2 P-1 Q-2\nG5.1 X7 Y1 I1 J1\nG2 X1 I-3 P2\nM70\nG20 G95 S100 M3\nM72\nM62 P1\nM100 P2\nG59.3 G61\nM61 Q3\n",
    "PARTNO A\nUNITS/MM\nMULTAX/ON\nCUTTER/10,5,0,5,0,0,50\nLOADTL/1\nSPINDL/900,RPM,CLW\nRAPID\nGOTO/0,0,10,0,0,1\n"
    "FEDRAT/100,MMPM\nGOTO/1,2,$\n3,0,0.6,0.8\nGODLTA/0,0,-1\nCIRCLE/1,0,2,0,0,1,2\nGOTO/3,0,2\n$$ end\nFINI\n",
};
constexpr std::size_t kSeedCount = std::size(kSeeds);

std::string mutated(std::size_t seed, std::mt19937& random) {
  std::string text = kSeeds[seed];
  static const std::string kBytes = "GMXYZABCIJKRFSTHNOPQL0123456789.+-%();/#[]<>=*,$\n\r\t \x80\xFF";
  for (std::size_t k = 0, count = 1 + random() % 4; k < count && !text.empty(); ++k) {
    const std::size_t at = random() % text.size();
    switch (random() % 10) {
      case 0:
        text[at] = kBytes[random() % kBytes.size()];
        break;
      case 1:
        text.erase(at, 1 + random() % 8);
        break;
      case 2:
        text.insert(at, 1 + random() % 3, kBytes[random() % kBytes.size()]);
        break;
      case 3:
        text.insert(at, text.substr(random() % text.size(), random() % 40));
        break;
      case 4:
        text[at] = static_cast<char>(random());
        break;
      default:  // another number: most of these are still programs
        if (text[at] >= '0' && text[at] <= '9') text[at] = static_cast<char>('0' + random() % 10);
    }
  }
  return text;
}

TEST(ReaderFuzz, GivesAValidProgramOrAFormatError) {
  std::mt19937 random(20);
  int read = 0, refused = 0;
  for (int round = 0; round < test::cases(20'000); ++round) {
    const std::size_t seed = static_cast<std::size_t>(round) % kSeedCount;
    const std::string text = mutated(seed, random);
    Program p;
    try {
      // Coarse chords: a mutation may ask for an arc of kilometres.
      Options options{{"chord_tolerance", 0.1}};
      const bool is_apt = seed + 1 == kSeedCount, is_heidenhain = seed < 2, is_sinumerik = seed == 2 || seed == 3;
      if (!is_apt) options["max_turns"] = 1000.0;
      if (random() % 4 == 0) options["unknown"] = std::string("skip");
      p = parse_nc(text, "fuzz.ngc",
                   {is_apt          ? "apt"
                    : is_heidenhain ? "heidenhain"
                    : is_sinumerik  ? "sinumerik"
                    : random() % 4  ? "tcp"
                                    : "3-axis",
                    options});
    } catch (const FormatError& e) {
      ++refused;
      ASSERT_EQ(std::string(e.what()).rfind("fuzz.ngc, line ", 0), 0U) << e.what();
      continue;
    }
    ++read;
    for (std::size_t row = 0; row < p.size(); ++row) {
      ASSERT_TRUE(geom::finite(p.poses()[row].tip)) << text;
      ASSERT_NEAR(glm::length(p.poses()[row].axis), 1, 1e-12) << text;
      ASSERT_TRUE(std::isfinite(p.feed()[row]) && p.feed()[row] >= 0) << text;
      ASSERT_GE(p.line()[row], 1);
    }
  }
  EXPECT_GT(read, test::cases(4000)) << "the seeds are too fragile to test what is read";
  EXPECT_GT(refused, test::cases(4000));
}

TEST(ReaderFuzz, BeginsWithConversationalProgramsThatAreRead) {
  for (std::size_t seed = 0; seed < 2; ++seed)
    EXPECT_GT(parse_nc(kSeeds[seed], "seed.h", {"heidenhain", {}}).size(), 20U);
}

TEST(ReaderFuzz, BeginsWithSinumerikProgramsThatAreRead) {
  for (std::size_t seed = 2; seed < 4; ++seed)
    EXPECT_GT(parse_nc(kSeeds[seed], "seed.mpf", {"sinumerik", {}}).size(), 20U);
}

TEST(ReaderFuzz, SurvivesBytesOfAnyKind) {
  std::mt19937 random(21);
  for (int round = 0; round < 5'000; ++round) {
    std::string text(random() % 200, '\0');
    for (char& c : text) c = static_cast<char>(round % 2 ? random() : "GXYZ[]#<>=o1 23.-\nsubif"[random() % 23]);
    for (const char* machine : {"tcp", "apt", "heidenhain", "sinumerik"}) {
      try {
        parse_nc((machine[0] == 'h' ? "BEGIN PGM F MM\n" : "") + text, "fuzz.ngc", {machine, {}});
      } catch (const FormatError&) {
      }
    }
  }
}

TEST(ReaderFuzz, SurvivesDeepNesting) {
  const auto many = [](const std::string& what, int count) {
    std::string out;
    for (int k = 0; k < count; ++k) out += what;
    return out;
  };
  for (const std::string& text :
       {"G0 X" + many("[", 100'000),
        "G0 X" + many("#", 100'000) + "1",
        "G0 X" + many("-[", 100'000),
        "G0 X" + many("SIN[", 100'000),
        many("G0", 100'000),
        many("o1 repeat [2]\n", 2000),
        many("o1 do\n", 2000),
        "G0 X[1" + many("**1", 100'000) + "]",
        "G0 X[1" + many("+1*2**3", 50'000) + "]",
        many("o1 call\n", 50),
        many("G0 X#1 #1=1\n", 20'000),
        std::string("o1 sub\no1 call\no1 call\no1 endsub\no1 call\n"),
        many("(", 100'000),
        "%_N_A_MPF\nR1=" + many("(", 100'000),
        "%_N_A_MPF\nR1=" + many("-", 100'000),
        "%_N_A_MPF\nR1=" + many("SIN(", 100'000),
        "%_N_A_MPF\nR1=" + many("R[", 100'000),
        "%_N_A_MPF\nR1=1" + many("+1*2", 50'000),
        "%_N_A_MPF\n" + many("LOOP\n", 50'000) + many("ENDLOOP\n", 50'000),
        std::string("%_N_A_MPF\nA: X1\nREPEAT A P=99999999\n"),
        std::string("%_N_A_MPF\nG0 X0 Y0 Z0\nMCALL CYCLE81(9,0,1,-1)\nHOLES2(0,0,5,0,0,99999)\n"),
        std::string("%_N_A_MPF\nA(1) P99999999\nM30\nPROC A(REAL X)\nA(1)\nRET\n"),
        "BEGIN PGM A MM\nQ1 = " + many("(", 100'000),
        "BEGIN PGM A MM\nQ1 = " + many("-", 100'000),
        "BEGIN PGM A MM\nQ1 = " + many("SIN ", 100'000),
        "BEGIN PGM A MM\nQ1 = 1" + many("+1^2", 50'000),
        std::string("BEGIN PGM A MM\nLBL 1\nCALL LBL 1\n"),
        "BEGIN PGM A MM\n" + many("Q1=1~\n", 50'000),
        std::string("BEGIN PGM A MM\nL X0 Y0 Z0 FMAX\nLBL 1\nL IX1 FMAX\nCALL LBL 1 REP 99999999\n")}) {
    try {
      parse_nc(text, "fuzz.ngc",
               {text.starts_with("BEGIN")  ? "heidenhain"
                : text.starts_with("%_N_") ? "sinumerik"
                                           : "tcp",
                {{"max_turns", 10'000.0}}});
    } catch (const FormatError&) {
    }
  }
}

}  // namespace
}  // namespace riffler::nc::reader_fuzz_test
