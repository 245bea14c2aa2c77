#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "support/nc_reading.hpp"

namespace riffler::nc::stream_test {
namespace {

class NcStreamFile : public testing::Test {
 protected:
  NcStreamFile() : path_(std::filesystem::temp_directory_path() / ("riffler_stream_" + std::to_string(getpid()))) {}
  ~NcStreamFile() override { std::filesystem::remove(path_); }
  void write(const std::string& text) { std::ofstream(path_, std::ios::binary) << text; }

  /// Whether the chunks, put together, are the program that is read at once.
  void expect_as_read(const ReadOptions& options, std::size_t rows) {
    const Program whole = read_nc(path_, options);
    NcStream stream(path_, options, rows);
    Program chunk;
    std::size_t row = 0, chunks = 0;
    while (stream.next(chunk)) {
      ASSERT_LE(chunk.size(), rows);
      for (std::size_t k = 0; k < chunk.size(); ++k) {
        if (k == 0 && chunks > 0) --row;  // the row at which the chunk before ended
        const Move a = chunk[k], b = whole[row++];
        ASSERT_TRUE(a.pose.tip == b.pose.tip && a.pose.axis == b.pose.axis && a.feed == b.feed && a.line == b.line &&
                    a.rapid == b.rapid && a.tool == b.tool && a.spindle == b.spindle);
      }
      ++chunks;
      EXPECT_EQ(chunk.provenance[0].second, path_.filename().string());
    }
    EXPECT_EQ(row, whole.size());
    EXPECT_EQ(chunks, whole.size() <= rows ? 1 : 1 + (whole.size() - rows + rows - 2) / (rows - 1));
    EXPECT_TRUE(chunk.empty());
    EXPECT_FALSE(stream.next(chunk));
  }

  std::filesystem::path path_;
};

TEST_F(NcStreamFile, GivesTheRowsThatReadingGives) {
  std::string text = "G0 X1\nF100\no1 sub\nG2 I5 Z#1\no1 endsub\n";
  for (int k = 0; k < 300; ++k) text += "G1 X" + std::to_string(k) + "\no1 call [" + std::to_string(k % 7) + "]\n";
  write(text);
  for (const std::size_t rows : {2, 3, 7, 100, 5000, 1'000'000}) expect_as_read({}, rows);
}

TEST_F(NcStreamFile, GivesAptRowsToo) {
  std::string text = "UNITS/MM\nFEDRAT/100\n";
  for (int k = 0; k < 50; ++k) text += "GOTO/" + std::to_string(k) + ",0,0\n";
  write(text);
  for (const std::size_t rows : {2, 10, 50, 51}) expect_as_read({"apt", {}}, rows);
}

TEST_F(NcStreamFile, ReportsAnErrorWhenItReachesIt) {
  write("G0 X1 Y0 Z0\nX2\nX3\nX\n");
  NcStream stream(path_, {}, 3);
  Program chunk;
  ASSERT_TRUE(stream.next(chunk));
  EXPECT_EQ(chunk.size(), 3U);
  EXPECT_THROW(stream.next(chunk), FormatError);
  EXPECT_FALSE(stream.next(chunk));
  EXPECT_THROW(NcStream(path_, {}, 1), std::invalid_argument);
  EXPECT_THROW(NcStream("/nowhere/at/all.ngc"), FormatError);
  write("");
  NcStream empty(path_);
  EXPECT_FALSE(empty.next(chunk));
}

}  // namespace
}  // namespace riffler::nc::stream_test
