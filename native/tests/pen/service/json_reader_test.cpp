#include "pen/service/json_reader.hpp"

#include <gtest/gtest.h>

#include <string>

#include "stress/random.hpp"

namespace riffler::pen::json_reader_test {
namespace {

bool good(std::string_view text) {
  JsonReader json(text);
  json.skip();
  return json.done();
}

TEST(JsonReader, ReadsValidJson) {
  for (const char* text : {"0", "-0", "12.5e-3", "1E+2", "true", "false", "null", "\"\"", R"("a\"\\\/\b\f\n\r\tä")",
                           "[]", "{}", " [ 1 , 2 ] ", R"({"a":{"b":[1,{"c":null}]},"d":"e"})", "\t\r\n1\n", "\"ä\""})
    EXPECT_TRUE(good(text)) << text;
}

TEST(JsonReader, RefusesInvalidJson) {
  for (const char* text : {"",
                           " ",
                           "01",
                           "+1",
                           "1.",
                           ".5",
                           "1e",
                           "-",
                           "0x1",
                           "NaN",
                           "Infinity",
                           "1e999",
                           "tru",
                           "nul",
                           "'a'",
                           "\"a",
                           "\"\\x\"",
                           "\"\\u12g4\"",
                           "\"\\u12",
                           "\"\t\"",
                           "[1,]",
                           "[,1]",
                           "[1 2]",
                           "[1",
                           "]",
                           "{",
                           "{\"a\"}",
                           "{\"a\":}",
                           "{a:1}",
                           "{\"a\":1,}",
                           "{\"a\":1 \"b\":2}",
                           "{1:2}",
                           "[1}",
                           "{\"a\":1]",
                           "1 2",
                           "[] []",
                           "\xEF\xBB\xBF[]",
                           "//"})
    EXPECT_FALSE(good(text)) << text;
}

TEST(JsonReader, DepthIsBounded) {
  const auto nested = [](std::size_t n) { return std::string(n, '[') + std::string(n, ']'); };
  EXPECT_TRUE(good(nested(JsonReader::kDeepest)));
  EXPECT_FALSE(good(nested(JsonReader::kDeepest + 1)));
  EXPECT_FALSE(good(nested(1'000'000)));
}

TEST(JsonReader, GivesTheValues) {
  JsonReader json(R"({"x":-1.25,"on":true,"name":"a\u0062","list":[1,2,3],"skipped":{"x":9}})");
  std::string_view key, name;
  double x = 0, sum = 0, v = 0;
  bool on = false;
  ASSERT_TRUE(json.object());
  while (json.key(key)) {
    if (key == "x") {
      EXPECT_TRUE(json.number(x));
    } else if (key == "on") {
      EXPECT_TRUE(json.boolean(on));
    } else if (key == "name") {
      EXPECT_TRUE(json.string(name));
    } else if (key == "list") {
      ASSERT_TRUE(json.array());
      while (json.element()) sum += json.number(v) ? v : 0;
    } else {
      EXPECT_TRUE(json.skip());
    }
  }
  EXPECT_TRUE(json.done());
  EXPECT_EQ(x, -1.25);
  EXPECT_TRUE(on);
  EXPECT_EQ(name, R"(a\u0062)");
  EXPECT_EQ(sum, 6);
}

TEST(JsonReader, AValueOfAnotherKindIsALastingError) {
  JsonReader json(R"({"x":"1","y":2})");
  std::string_view key;
  double x = 7;
  ASSERT_TRUE(json.object());
  ASSERT_TRUE(json.key(key));
  EXPECT_FALSE(json.number(x));
  EXPECT_EQ(x, 7);
  EXPECT_FALSE(json.key(key));
  EXPECT_FALSE(json.skip());
  EXPECT_FALSE(json.ok());
}

/// What ends anywhere, and any bytes, are read to an answer without reading beyond the end.
TEST(JsonReader, SurvivesEveryPrefixAndAnyBytes) {
  const std::string text = R"({"a":[1.5e3,-2,"b\n\u00e4"],"c":{"d":true,"e":null}})";
  for (std::size_t n = 0; n < text.size(); ++n) EXPECT_FALSE(good(std::string(text, 0, n))) << n;
  stress::Random random(4);
  constexpr std::string_view kBytes = "{}[]\",:\\u0123-+.eEtrufalsn \n\xC3\x01";
  int accepted = 0;
  for (int k = 0; k < 200'000; ++k) {
    std::string some;
    const auto n = static_cast<std::size_t>(random.uniform() * 12);
    for (std::size_t j = 0; j < n; ++j)
      some += kBytes[static_cast<std::size_t>(random.uniform() * static_cast<double>(kBytes.size()))];
    accepted += good(std::string(some));
  }
  EXPECT_GT(accepted, 100);
  EXPECT_LT(accepted, 40'000);
}

}  // namespace
}  // namespace riffler::pen::json_reader_test
