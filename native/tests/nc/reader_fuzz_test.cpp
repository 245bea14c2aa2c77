// Mutated programs: whatever the text is, the reader gives a valid program or one FormatError.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "geom/error.hpp"
#include "nc/reader.hpp"
#include "nc/writer.hpp"

namespace riffler {
namespace {

const std::string kSeeds[] = {
    "%\nO1 (SEED)\nN1 G21 G90 G94 G17 G40 G49 G80 G54\nT1 M6\nS8000 M3\nG43.4 H1\nG0 X10.00000 Y-20.5 Z30 A10.5 "
    "C-120.25\n"
    "G1 Z5 F600\nX20 A20\nX30.125 Y2 C-100\nG93 X40 F2.5\nX41 C-90 F3\nG94 G0 Z30 A0\nM5\nG49\nM30\n%\n",
    "G20 G91\nG1 X1 F10 ; inch\nG2 X1 Y1 I1 J0\nG3 X-1 Y-1 R1\nG18 G2 X1 Z1 K1\nG19 G3 Y1 Z1 R-1\nG17 G2 I.5 "
    "Z.1\nG90.1\n"
    "G90 G3 X2 Y2 I2 J1\nG4 P1\nG64 P.01 Q.02\nM7 M8\nM9 M1\nM2\n",
};

std::string mutated(std::mt19937& random) {
  std::string text = kSeeds[random() % 2];
  static const std::string kBytes = "GMXYZABCIJKRFSTHNOPQ0123456789.+-%();/#\n\r\t \x80\xFF";
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
  for (int round = 0; round < 20'000; ++round) {
    const std::string text = mutated(random);
    Program p;
    try {
      // Coarse chords: a mutation may ask for an arc of kilometres.
      p = parse_nc(text, "fuzz.ngc", {round % 4 ? "tcp" : "3-axis", {{"chord_tolerance", 0.1}}});
    } catch (const FormatError& e) {
      ++refused;
      ASSERT_EQ(std::string(e.what()).rfind("fuzz.ngc, line ", 0), 0U) << e.what();
      continue;
    }
    ++read;
    for (std::size_t row = 0; row < p.size(); ++row) {
      ASSERT_TRUE(finite(p.poses()[row].tip)) << text;
      ASSERT_NEAR(glm::length(p.poses()[row].axis), 1, 1e-12) << text;
      ASSERT_TRUE(std::isfinite(p.feed()[row]) && p.feed()[row] >= 0) << text;
      ASSERT_GE(p.line()[row], 1);
    }
  }
  EXPECT_GT(read, 1000) << "the seeds are too fragile to test what is read";
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace riffler
