#include "base/nearest_word.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace riffler::base::nearest_word_test {
namespace {

const std::vector<std::string> kKnown{"tcp", "feed", "rapids", "max_rotary", "limits_x", "limits_a", "safe_height"};

std::string hint(std::string_view word) {
  return nearest_word_hint(word, kKnown);
}

TEST(NearestWord, IsNamedForOneEditOfEachKind) {
  EXPECT_EQ(hint("max_rotaryy"), "; did you mean max_rotary?") << "inserted";
  EXPECT_EQ(hint("max_rotry"), "; did you mean max_rotary?") << "left out";
  EXPECT_EQ(hint("max_rotory"), "; did you mean max_rotary?") << "replaced";
  EXPECT_EQ(hint("max_roatry"), "; did you mean max_rotary?") << "exchanged";
  EXPECT_EQ(hint("Safe-Height"), "; did you mean safe_height?") << "case does not count";
}

TEST(NearestWord, MayDifferByAThirdOfTheLongerWord) {
  EXPECT_EQ(hint("tpc"), "; did you mean tcp?") << "one exchange of three letters";
  EXPECT_EQ(hint("cap"), "") << "two of three letters: not a misspelling";
  EXPECT_EQ(hint("feet"), "; did you mean feed?");
  EXPECT_EQ(hint("fest"), "");
  EXPECT_EQ(hint("safe_high"), "; did you mean safe_height?") << "two letters of eleven";
  EXPECT_EQ(hint("safe"), "");
}

TEST(NearestWord, IsTheNearestAndTheFirstOfEqualOnes) {
  EXPECT_EQ(hint("limits_b"), "; did you mean limits_x?");
  EXPECT_EQ(hint("limitsa"), "; did you mean limits_a?");
}

TEST(NearestWord, IsNoneIfNoWordIsSimilar) {
  EXPECT_EQ(hint(""), "");
  EXPECT_EQ(hint("nonsense"), "");
  EXPECT_EQ(hint(std::string(1'000'000, 'x')), "");
  EXPECT_EQ(nearest_word_hint("tcp", {}), "");
}

}  // namespace
}  // namespace riffler::base::nearest_word_test
