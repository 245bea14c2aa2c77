// What stays of a journal when the disk takes no more: short writes, then errors.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <stdexcept>

#include "base/io.hpp"
#include "riffler/session/journal_file.hpp"
#include "support/file_limit.hpp"
#include "support/temporary_file.hpp"

namespace riffler::session::journal_disk_test {
namespace {

using test::FileLimit;
using test::TemporaryFile;

JournalStroke stroke(int rows, double x) {
  JournalStroke out{1};
  for (int k = 0; k < rows; ++k) out.poses.push_back({{x, 0.1 * k, std::sqrt(k)}, {0, 0, 1}});
  return out;
}

TEST(JournalDisk, FullAtAnyByteOfARecordKeepsAllEarlierRecords) {
  const TemporaryFile file("disk.rjournal");
  JournalWriter writer(file.path);
  writer.add_tool(1, "{}");
  writer.add_stroke(stroke(20, 0));
  const auto whole = base::read_file(file.path);
  const std::size_t size = whole.size();
  for (std::size_t more = 0; more < 28; ++more) {
    {
      const FileLimit full(size + more);
      EXPECT_THROW(writer.add_stroke(stroke(20, 1)), std::runtime_error);
      EXPECT_THROW(writer.extend_stroke(stroke(20, 2).rows()), std::runtime_error);
      EXPECT_THROW(writer.undo(), std::runtime_error) << "28 bytes, the shortest";
    }
    ASSERT_EQ(base::read_file(file.path), whole) << more;
  }
  EXPECT_EQ(writer.journal().strokes().size(), 1U);
  writer.add_stroke(stroke(20, 3));
  writer.close();
  const Journal j = read_journal(file.path);
  EXPECT_FALSE(j.cut_at);
  ASSERT_EQ(j.strokes().size(), 2U);
  EXPECT_EQ(j.strokes()[1].poses[0].tip.x, 3);
}

TEST(JournalDisk, WriterContinuesOnceThereIsRoomAgain) {
  // A record may be refused, a shorter one taken after it.
  const TemporaryFile file("room.rjournal");
  JournalWriter writer(file.path, JournalWriter::Keep::Rules);
  writer.add_tool(1, "{}");
  std::size_t taken = 0, refused = 0;
  {
    const FileLimit full(4000);
    for (int k = 0; k < 60; ++k) {
      try {
        writer.add_stroke(stroke(1 + 7 * (k % 5), k));
        ++taken;
      } catch (const std::runtime_error& e) {
        ++refused;
        EXPECT_NE(std::string(e.what()).find("cannot be written"), std::string::npos) << e.what();
      }
      const Journal j = read_journal(file.path);
      ASSERT_FALSE(j.cut_at);
      ASSERT_EQ(j.strokes().size(), taken);
    }
  }
  EXPECT_GT(taken, 10U);
  EXPECT_GT(refused, 10U);
  writer.add_stroke(stroke(100, 99));
  EXPECT_EQ(read_journal(file.path).strokes().back().poses.size(), 100U);
}

TEST(JournalDisk, FullAtTheHeaderLeavesAUsableFile) {
  const TemporaryFile file("header.rjournal");
  for (const unsigned size : {0, 8, 15}) {
    const FileLimit full(size);
    EXPECT_THROW(JournalWriter writer(file.path), std::runtime_error);
  }
  JournalWriter writer(file.path);
  writer.add_note("a", "b");
  EXPECT_EQ(read_journal(file.path).notes().size(), 1U);
}

}  // namespace
}  // namespace riffler::session::journal_disk_test
