#include "nc/read/cursor.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>
#include <string>

#include "riffler/base/error.hpp"

namespace riffler::nc::cursor_test {
namespace {

double number(const std::string& text) {
  const NcPlace place{"p", 1, text};
  NcCursor cursor(text, place);
  return cursor.number('X');
}

TEST(NcCursor, ReadsNumbersToTheLastBit) {
  std::mt19937_64 random(7);
  for (int round = 0; round < 200'000; ++round) {
    // Up to 20 digits with the point anywhere: what the quick parser takes, and what it leaves to the library.
    std::string text = round % 3 == 0 ? "-" : round % 3 == 1 ? "+" : "";
    const std::size_t digits = 1 + random() % 20, point = random() % (digits + 1);
    for (std::size_t k = 0; k < digits; ++k) {
      if (k == point) text += '.';
      text += static_cast<char>('0' + random() % 10);
    }
    ASSERT_EQ(number(text), std::strtod(text.c_str(), nullptr)) << text;
  }
  EXPECT_EQ(number("  000000000000000000000000012.5000000000000000000000"), 12.5);
  EXPECT_EQ(number("5."), 5);
  EXPECT_EQ(number("-.5"), -0.5);
}

TEST(NcCursor, SkipsBlanksAndComments) {
  const std::string text = " \t(one) g (two)(three)\t1 ; rest (";
  const NcPlace place{"p", 1, text};
  NcCursor cursor(text, place);
  EXPECT_EQ(cursor.peek(), 'G');
  cursor.take();
  EXPECT_EQ(cursor.number('G'), 1);
  EXPECT_EQ(cursor.peek(), '\0');
}

TEST(NcCursor, NamesAreLowerCaseWithoutBlanks) {
  const std::string text = "A Long_Name 1>=";
  const NcPlace place{"p", 1, text};
  NcCursor cursor(text, place);
  EXPECT_EQ(cursor.name(), "along_name1");
  EXPECT_EQ(cursor.peek(), '=');
}

TEST(NcPlace, NamesFileLineAndTheBeginningOfTheBlock) {
  const std::string text = "\tG1 \x01 " + std::string(100, 'x');
  try {
    NcPlace{"part.ngc", 12, text}.fail("what it is");
  } catch (const FormatError& e) {
    EXPECT_EQ(std::string(e.what()), "part.ngc, line 12: what it is [G1 ? " + std::string(74, 'x') + " ...]");
  }
}

}  // namespace
}  // namespace riffler::nc::cursor_test
