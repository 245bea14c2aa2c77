// Strokes that are taken back and brought back.
#include <gtest/gtest.h>

#include <random>
#include <stdexcept>
#include <vector>

#include "riffler/base/error.hpp"
#include "riffler/session/journal_file.hpp"
#include "session/journal_records.hpp"
#include "support/error_of.hpp"
#include "support/temporary_file.hpp"

namespace riffler::session::journal_undo_test {
namespace {

using test::error_of;
using test::TemporaryFile;

/// A stroke that is known by its tip's x.
JournalStroke numbered(int x) {
  return {1, 0.01, "", {{{x, 0, 0}, {0, 0, 1}}, {{x, 1, 0}, {0, 0, 1}}}};
}

std::vector<int> numbers(std::span<const JournalStroke> strokes) {
  std::vector<int> out;
  for (const JournalStroke& s : strokes) out.push_back(static_cast<int>(s.poses[0].tip.x));
  return out;
}

Journal five() {
  Journal j;
  j.add_tool(1, "{}");
  for (int k = 0; k < 5; ++k) j.add_stroke(numbered(k));
  return j;
}

TEST(JournalUndo, UndoesAndRedoesTheLastStrokesInOrder) {
  Journal j = five();
  j.undo(2);
  EXPECT_EQ(numbers(j.strokes()), (std::vector{0, 1, 2}));
  j.undo();
  EXPECT_EQ(numbers(j.taken_back()), (std::vector{2, 3, 4}));
  j.redo(2);
  EXPECT_EQ(numbers(j.strokes()), (std::vector{0, 1, 2, 3}));
  EXPECT_EQ(error_of([&] { j.redo(2); }), "strokes to redo must be from 1 to 1");
  j.add_stroke(numbered(9));
  EXPECT_EQ(numbers(j.strokes()), (std::vector{0, 1, 2, 3, 9}));
  EXPECT_EQ(error_of([&] { j.redo(); }), "there is no stroke to redo") << "a new stroke ends redo";
  j.undo(5);
  EXPECT_TRUE(j.strokes().empty());
  EXPECT_TRUE(to_program(j, {}).empty());
}

TEST(JournalUndo, EndsTheStroke) {
  Journal j = five();
  j.undo();
  EXPECT_EQ(error_of([&] { j.extend_stroke({numbered(3).poses}); }), "the last stroke has ended: begin another");
  j.redo();
  EXPECT_EQ(error_of([&] { j.extend_stroke({numbered(4).poses}); }), "the last stroke has ended: begin another");
  EXPECT_EQ(j.strokes()[4].poses.size(), 2U);
}

TEST(JournalUndo, IsInTheFileAndCanBeRedoneFromIt) {
  Journal j = five();
  j.undo(3);
  Journal k = parse_journal(to_bytes(j), "j");
  EXPECT_EQ(numbers(k.strokes()), (std::vector{0, 1}));
  EXPECT_EQ(to_bytes(k), to_bytes(j));
  k.redo(2);
  EXPECT_EQ(numbers(k.strokes()), (std::vector{0, 1, 2, 3}));
}

TEST(JournalUndo, OfMissingStrokesIsAFormatError) {
  const Bytes whole = to_bytes(five());
  for (const auto& record : {journal_format::undo_record, journal_format::redo_record})
    for (const std::size_t n : {std::size_t{0}, std::size_t{6}, ~std::size_t{0}}) {
      Bytes bytes = whole;
      const Bytes more = record(n);
      bytes.insert(bytes.end(), more.begin(), more.end());
      try {
        parse_journal(bytes, "j");
        ADD_FAILURE() << n;
      } catch (const FormatError& e) {
        EXPECT_EQ(std::string(e.what()).rfind("j, byte " + std::to_string(whole.size()) + ": ", 0), 0U) << e.what();
      }
    }
}

TEST(JournalUndo, WriterAgreesWithTheJournalWhicheverRowsItKeeps) {
  // Random histories, against a list and a stack of what was taken back.
  std::mt19937 random(5);
  for (int round = 0; round < 20; ++round) {
    const TemporaryFile file("undo.rjournal");
    std::vector<int> counts, taken;
    {
      JournalWriter writer(file.path, round % 2 ? JournalWriter::Keep::Rules : JournalWriter::Keep::Everything);
      writer.add_tool(1, "{}");
      for (int k = 0; k < 60; ++k) {
        const std::size_t n = 1 + random() % 3;
        switch (random() % 4) {
          case 0:
            if (n > counts.size()) {
              EXPECT_THROW(writer.undo(n), std::invalid_argument);
              break;
            }
            writer.undo(n);
            for (std::size_t i = 0; i < n; ++i) taken.push_back(counts.back()), counts.pop_back();
            break;
          case 1:
            if (n > taken.size()) {
              EXPECT_THROW(writer.redo(n), std::invalid_argument);
              break;
            }
            writer.redo(n);
            for (std::size_t i = 0; i < n; ++i) counts.push_back(taken.back()), taken.pop_back();
            break;
          default:
            writer.add_stroke(numbered(k));
            counts.push_back(k), taken.clear();
        }
        if (random() % 10 == 0) {
          ASSERT_EQ(numbers(read_journal(file.path).strokes()), counts);
        }
      }
      if (round % 2 == 0) {
        EXPECT_EQ(numbers(writer.journal().strokes()), counts);
      }
    }
    const Journal j = read_journal(file.path);
    EXPECT_EQ(numbers(j.strokes()), counts);
    EXPECT_EQ(numbers(j.taken_back()), std::vector<int>(taken.rbegin(), taken.rend()));
  }
}

}  // namespace
}  // namespace riffler::session::journal_undo_test
