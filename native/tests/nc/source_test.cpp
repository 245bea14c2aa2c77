#include "nc/source.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "riffler/base/error.hpp"

namespace riffler::nc::source_test {
namespace {

class NcSourceFile : public testing::Test {
 protected:
  NcSourceFile() : path_(std::filesystem::temp_directory_path() / ("riffler_source_" + std::to_string(getpid()))) {}
  ~NcSourceFile() override { std::filesystem::remove(path_); }
  void write(const std::string& text) { std::ofstream(path_, std::ios::binary) << text; }

  std::filesystem::path path_;
};

TEST_F(NcSourceFile, GivesTheSameLinesAsMemoryForAFileLargerThanItsWindow) {
  std::mt19937 random(3);
  std::string text;
  for (int line = 0; line < 500; ++line)
    text += std::string(random() % 60, static_cast<char>('a' + line % 26)) + (random() % 2 ? "\r\n" : "\n");
  text += "the last without an end";
  write(text);
  NcSource memory(text, "m"), file(path_, 64);
  std::vector<NcSource::Mark> marks;
  std::vector<std::string> lines;
  std::string_view a, b;
  while (true) {
    marks.push_back(file.mark());
    const bool more = memory.next(a);
    ASSERT_EQ(file.next(b), more);
    if (!more) break;
    ASSERT_EQ(a, b);
    ASSERT_EQ(file.line(), memory.line());
    lines.emplace_back(b);
  }
  for (int jump = 0; jump < 1000; ++jump) {
    const std::size_t k = random() % lines.size();
    file.go(marks[k]), memory.go(marks[k]);
    ASSERT_TRUE(file.next(b) && memory.next(a));
    ASSERT_EQ(b, lines[k]);
    ASSERT_EQ(a, lines[k]);
    ASSERT_EQ(file.line(), static_cast<int>(k) + 1);
  }
}

TEST_F(NcSourceFile, RefusesALineThatDoesNotFit) {
  write("short\n" + std::string(65, 'x') + "\n");
  NcSource file(path_, 64);
  std::string_view line;
  ASSERT_TRUE(file.next(line));
  EXPECT_THROW(file.next(line), FormatError);
}

TEST(NcSource, RefusesPathsThatAreNotFiles) {
  EXPECT_THROW(NcSource(std::filesystem::path("/nowhere/at/all")), FormatError);
  EXPECT_THROW(NcSource(std::filesystem::temp_directory_path()), FormatError);
}

}  // namespace
}  // namespace riffler::nc::source_test
