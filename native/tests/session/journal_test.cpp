#include "riffler/session/journal.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <stdexcept>

#include "base/bytes.hpp"
#include "base/io.hpp"
#include "riffler/base/error.hpp"
#include "riffler/session/journal_file.hpp"
#include "support/error_of.hpp"
#include "support/temporary_file.hpp"

namespace riffler::session::journal_test {
namespace {

using test::error_of;
using test::TemporaryFile;

const std::string kBall = R"({"kind": "ball", "diameter": 6, "length": 30})";

JournalStroke wavy(int rows, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  JournalStroke s{1, 0.005, "wave \xC3\xA9"};
  for (int i = 0; i < rows; ++i) {
    const double t = 1e-3 * i;
    s.poses.push_back({{50 * t, 20 * std::sin(3 * t), -5 * t + 1e-4 * normal(random)},
                       glm::normalize(Vec3(0.3 * std::sin(t), 0.2, 1))});
    s.times.push_back(t);
  }
  return s;
}

/// As a session of the pen leaves it: with what was felt and cut.
JournalStroke felt(int rows, unsigned seed = 1) {
  JournalStroke s = wavy(rows, seed);
  std::mt19937 random(seed + 100);
  std::normal_distribution<double> normal;
  for (int i = 0; i < rows; ++i) {
    s.forces.push_back({{normal(random), -0.0, 1e-310}, {normal(random), 1e300, -normal(random)}});
    s.removed.push_back(std::abs(normal(random)));
  }
  return s;
}

/// Each column that may be missing, missing.
std::vector<JournalStroke> with_all_columns(int rows) {
  std::vector<JournalStroke> out;
  for (unsigned mask = 0; mask < 8; ++mask) {
    JournalStroke s = felt(rows, mask + 1);
    if (mask & 1) s.times.clear();
    if (mask & 2) s.forces.clear();
    if (mask & 4) s.removed.clear();
    out.push_back(s);
  }
  return out;
}

Journal sample() {
  Journal j;
  j.add_note("program", "test");
  j.set_stock({{{0, 0, 0}, {100, 60, 30}}, 0.25, "xyz", "stock.rvol"});
  j.add_tool(1, kBall);
  j.add_tool(7, "{}");
  j.add_stroke(wavy(300));
  JournalStroke untimed = wavy(3);
  untimed.tool = 7, untimed.times.clear();
  j.add_stroke(untimed);
  j.add_stroke(wavy(1));
  j.add_stroke(felt(40));
  return j;
}

void expect_same(const JournalStroke& a, const JournalStroke& b) {
  EXPECT_EQ(a.tool, b.tool);
  EXPECT_EQ(a.tolerance, b.tolerance);
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.times, b.times);
  EXPECT_EQ(a.forces, b.forces);
  EXPECT_EQ(a.removed, b.removed);
  ASSERT_EQ(a.poses.size(), b.poses.size());
  for (std::size_t k = 0; k < a.poses.size(); ++k) {
    EXPECT_EQ(a.poses[k].tip, b.poses[k].tip);
    EXPECT_EQ(a.poses[k].axis, b.poses[k].axis);
  }
}

void expect_same(const Journal& a, const Journal& b) {
  EXPECT_EQ(a.notes(), b.notes());
  EXPECT_EQ(a.tools(), b.tools());
  ASSERT_EQ(a.stock().has_value(), b.stock().has_value());
  if (a.stock()) {
    EXPECT_EQ(a.stock()->box.lower, b.stock()->box.lower);
    EXPECT_EQ(a.stock()->box.upper, b.stock()->box.upper);
    EXPECT_EQ(a.stock()->pitch, b.stock()->pitch);
    EXPECT_EQ(a.stock()->directions, b.stock()->directions);
    EXPECT_EQ(a.stock()->snapshot, b.stock()->snapshot);
  }
  ASSERT_EQ(a.strokes().size(), b.strokes().size());
  for (std::size_t k = 0; k < a.strokes().size(); ++k) expect_same(a.strokes()[k], b.strokes()[k]);
}

TEST(Journal, RoundTripsToTheBit) {
  const Journal j = sample();
  const Journal k = parse_journal(to_bytes(j), "j");
  expect_same(j, k);
  EXPECT_FALSE(k.cut_at);
  EXPECT_EQ(to_bytes(j), to_bytes(k));
  expect_same(Journal(), parse_journal(to_bytes(Journal()), "j"));
}

TEST(Journal, KeepsTheColumnsThatAStrokeHas) {
  Journal j;
  j.add_tool(1, kBall);
  for (const JournalStroke& s : with_all_columns(50)) {
    j.add_stroke(s);
    JournalStroke later = s;
    for (double& t : later.times) t += s.times.back();
    j.extend_stroke(later.rows());
  }
  const Journal k = parse_journal(to_bytes(j), "j");
  expect_same(j, k);
  EXPECT_TRUE(std::signbit(k.strokes()[0].forces[7].force.y));
  EXPECT_EQ(k.strokes()[0].poses.size(), 100U);
}

TEST(Journal, WithoutForcesHasTheBytesOfTheFirstRelease) {
  // Six columns, and seven with times, as files that are there have them: the number stands after the number of rows.
  Journal j;
  j.add_tool(1, kBall);
  const std::size_t begin = to_bytes(j).size() + 16 + 4 + 8 + 4 + 8;
  const auto code = [&](JournalStroke s) {
    s.name.clear();
    Journal k = j;
    k.add_stroke(s);
    return base::get<std::uint32_t>(to_bytes(k), begin);
  };
  const std::uint32_t wanted[] = {0x300 + 14, 0x300 + 13, 0x200 + 8, 0x200 + 7, 0x100 + 13, 0x100 + 12, 7, 6};
  std::vector<std::uint32_t> found;
  for (const JournalStroke& s : with_all_columns(3)) found.push_back(code(s));
  EXPECT_EQ(found, std::vector<std::uint32_t>(std::begin(wanted), std::end(wanted)));
}

TEST(Journal, KeepsEveryDoubleThatAPoseMayHold) {
  Journal j;
  j.add_tool(1, kBall);
  const double tiny = std::numeric_limits<double>::denorm_min(), most = std::numeric_limits<double>::max();
  JournalStroke s{1, 1, "", {{{-0.0, tiny, most}, {0, 0, -1}}, {{-most, -tiny, 0}, {0, 0, 1 + 1e-9}}}, {-1e300, 1e300}};
  j.add_stroke(s);
  const Journal k = parse_journal(to_bytes(j), "j");
  expect_same(s, k.strokes()[0]);
  EXPECT_TRUE(std::signbit(k.strokes()[0].poses[0].tip.x));
}

TEST(Journal, IsSmallerThanItsDoubles) {
  Journal j;
  j.add_tool(1, kBall);
  JournalStroke s = wavy(5000);
  for (Pose& pose : s.poses) pose.tip.z = 3;  // no noise
  j.add_stroke(s);
  EXPECT_LT(to_bytes(j).size(), 5000U * 7 * 8 / 2);
}

TEST(Journal, TruncatedAnywhereGivesAllWholeRecords) {
  const Journal whole = sample();
  const auto bytes = to_bytes(whole);
  std::size_t before = 0;
  for (std::size_t size = 16; size <= bytes.size(); ++size) {
    const Journal j = parse_journal(std::span(bytes).first(size), "j");
    const std::size_t records = j.notes().size() + j.stock().has_value() + j.tools().size() + j.strokes().size();
    EXPECT_GE(records, before);
    EXPECT_LE(records, before + 1);
    before = records;
    for (std::size_t k = 0; k < j.strokes().size(); ++k) expect_same(j.strokes()[k], whole.strokes()[k]);
    EXPECT_EQ(j.cut_at.value_or(size), to_bytes(j).size());
    EXPECT_EQ(j.cut_at.has_value(), to_bytes(j).size() < size) << "a cut without a report";
  }
  EXPECT_EQ(before, 8U);
  for (std::size_t size = 0; size < 16; ++size)
    EXPECT_THROW(parse_journal(std::span(bytes).first(size), "j"), FormatError);
}

TEST(Journal, TailOfZerosIsATruncatedTail) {
  auto bytes = to_bytes(sample());
  const std::size_t size = bytes.size();
  bytes.resize(size + 4096, 0);
  const Journal j = parse_journal(bytes, "j");
  EXPECT_EQ(j.cut_at, size);
  EXPECT_EQ(j.strokes().size(), 4U);
}

TEST(Journal, AnyDamagedByteIsFound) {
  const Journal whole = sample();
  const auto bytes = to_bytes(whole);
  // Where the last record begins: the file without it.
  std::size_t last = bytes.size();
  while (!parse_journal(std::span(bytes).first(last - 1), "j").cut_at) --last;
  last = *parse_journal(std::span(bytes).first(last - 1), "j").cut_at;
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    auto damaged = bytes;
    damaged[at] ^= 0x10;
    if (at >= last) {
      const Journal j = parse_journal(damaged, "j");
      EXPECT_EQ(j.cut_at, last) << at;
      EXPECT_EQ(j.strokes().size(), 3U);
      continue;
    }
    try {
      parse_journal(damaged, "j.rjournal");
      ADD_FAILURE() << "byte " << at << " went unnoticed";
    } catch (const FormatError& e) {
      EXPECT_EQ(std::string(e.what()).rfind("j.rjournal, byte ", 0), 0U) << e.what();
    }
  }
}

TEST(Journal, ForgedRecordsAreFormatErrors) {
  // Right checksums around wrong content: every byte of a payload replaced, the checksum made to fit.
  std::mt19937 random(2);
  Journal one;
  one.add_tool(1, kBall);
  const std::size_t prefix = to_bytes(one).size();
  one.add_stroke(felt(20));
  const auto bytes = to_bytes(one);
  const auto crc = [](std::span<const std::uint8_t> data) {
    std::uint32_t c = ~0U;
    for (const std::uint8_t byte : data) {
      c ^= byte;
      for (int k = 0; k < 8; ++k) c = c >> 1 ^ (c & 1 ? 0xEDB88320U : 0);
    }
    return ~c;
  };
  int refused = 0;
  for (int round = 0; round < 5000; ++round) {
    auto forged = bytes;
    const std::size_t begin = prefix + 16, end = forged.size() - 4;
    for (unsigned long k = 0, count = 1 + random() % 3; k < count; ++k)
      forged[begin + random() % (end - begin)] = static_cast<std::uint8_t>(random());
    const std::uint32_t sum = crc(std::span(forged).subspan(begin, end - begin));
    for (std::size_t k = 0; k < 4; ++k) forged[end + k] = static_cast<std::uint8_t>(sum >> (8 * k));
    try {
      const Journal j = parse_journal(forged, "j");
      ASSERT_EQ(j.strokes().size(), 1U) << "the checksum of the test is right";
      for (const Pose& pose : j.strokes()[0].poses) ASSERT_TRUE(geom::finite(pose.tip));
      for (const Wrench& wrench : j.strokes()[0].forces) ASSERT_TRUE(finite(wrench));
    } catch (const FormatError& e) {
      ++refused;
      ASSERT_NE(std::string(e.what()).find("byte " + std::to_string(prefix)), std::string::npos) << e.what();
    }
  }
  EXPECT_GT(refused, 1000);
}

TEST(Journal, RefusesOtherFilesAndVersions) {
  const std::string stl = "solid something else altogether";
  const std::vector<std::uint8_t> other(stl.begin(), stl.end());
  EXPECT_THROW(parse_journal(other, "j"), FormatError);
  EXPECT_THROW(parse_journal({}, "j"), FormatError);
  EXPECT_THROW(read_journal("/nowhere/at/all.rjournal"), FormatError);
}

TEST(Journal, NamesBadInputAndStaysUnchanged) {
  Journal j = sample();
  const auto before = to_bytes(j);
  const auto with = [](auto change) {
    JournalStroke s = wavy(3);
    change(s);
    return s;
  };
  const double nan = std::nan("");
  EXPECT_NE(error_of([&] { j.set_stock({{{0, 0, 0}, {1, 1, 1}}, 1, "z", ""}); }), "");
  EXPECT_NE(error_of([&] { j.add_tool(1, "{}"); }), "");
  EXPECT_NE(error_of([&] { j.add_tool(0, "{}"); }), "");
  EXPECT_EQ(error_of([&] { j.add_stroke(with([](auto& s) { s.tool = 2; })); }),
            "tool 2 is not in the journal: add it first");
  EXPECT_NE(error_of([&] { j.add_stroke(with([](auto& s) { s.tolerance = 0; })); }), "");
  EXPECT_NE(error_of([&] { j.add_stroke(with([](auto& s) { s.poses.clear(), s.times.clear(); })); }), "");
  EXPECT_EQ(error_of([&] { j.add_stroke(with([&](auto& s) { s.poses[2].tip.y = nan; })); }),
            "poses, row 2: not finite");
  EXPECT_EQ(error_of([&] { j.add_stroke(with([](auto& s) { s.poses[1].axis *= 2.0; })); }),
            "poses, row 1: the axis is not a unit vector");
  EXPECT_EQ(error_of([&] { j.add_stroke(with([](auto& s) { s.times.pop_back(); })); }),
            "times must be as many as poses");
  EXPECT_EQ(error_of([&] { j.add_stroke(with([](auto& s) { s.times[2] = -1; })); }),
            "times, row 2: earlier than the one before");
  EXPECT_EQ(error_of([&] { j.add_stroke(with([&](auto& s) { s.times[1] = nan; })); }), "times, row 1: not finite");
  EXPECT_EQ(error_of([&] { j.add_stroke(with([&](auto& s) { s.forces = felt(2).forces; })); }),
            "forces must be as many as poses");
  EXPECT_EQ(
      error_of([&] { j.add_stroke(with([&](auto& s) { s.forces = felt(3).forces, s.forces[1].torque.z = nan; })); }),
      "forces, row 1: not finite");
  EXPECT_EQ(error_of([&] { j.add_stroke(with([&](auto& s) { s.removed = {1, 2}; })); }),
            "removed must be as many as poses");
  EXPECT_EQ(error_of([&] { j.add_stroke(with([&](auto& s) { s.removed = {1, 0, -1e-300}; })); }),
            "removed, row 2: must be finite and not negative");
  EXPECT_EQ(error_of([&] { j.undo(0); }), "strokes to undo must be from 1 to 4");
  EXPECT_EQ(error_of([&] { j.undo(5); }), "strokes to undo must be from 1 to 4");
  EXPECT_EQ(error_of([&] { Journal().undo(); }), "there is no stroke to undo");
  EXPECT_EQ(error_of([&] { j.redo(); }), "there is no stroke to redo");
  EXPECT_NE(error_of([&] { j.extend_stroke({wavy(2).poses}); }), "") << "the last stroke has times";
  EXPECT_NE(error_of([&] { Journal().extend_stroke({wavy(2).poses}); }), "");
  Journal fresh;
  EXPECT_NE(error_of([&] { fresh.set_stock({{{0, 0, 0}, {1, 0, 1}}, 1, "z", ""}); }), "");
  EXPECT_NE(error_of([&] { fresh.set_stock({{{0, 0, 0}, {1, 1, 1}}, nan, "z", ""}); }), "");
  EXPECT_NE(error_of([&] { fresh.set_stock({{{0, 0, 0}, {1, 1, 1}}, 1, "xz", ""}); }), "");
  EXPECT_EQ(to_bytes(j), before);
}

TEST(JournalWriter, AppendsAndContinuesAfterACrash) {
  const TemporaryFile file("append.rjournal");
  const JournalStroke s = wavy(100);
  {
    JournalWriter writer(file.path);
    writer.add_note("program", "test");
    writer.set_stock({{{0, 0, 0}, {100, 60, 30}}, 0.25, "z", ""});
    writer.add_tool(1, kBall);
    EXPECT_EQ(read_journal(file.path).tools().size(), 1U) << "there before the writer is closed";
    JournalStroke begun = s;
    begun.poses.resize(40), begun.times.resize(40);
    writer.add_stroke(begun);
    writer.extend_stroke({std::span(s.poses).subspan(40, 30), std::span(s.times).subspan(40, 30)});
    writer.extend_stroke({std::span(s.poses).subspan(70), std::span(s.times).subspan(70)});
    writer.sync();
    EXPECT_THROW(writer.add_tool(1, "{}"), std::invalid_argument);
    EXPECT_THROW(writer.extend_stroke(s.rows()), std::invalid_argument) << "time runs backwards";
  }
  expect_same(s, read_journal(file.path).strokes()[0]);

  // The crash: half of the last piece is gone.
  std::filesystem::resize_file(file.path, std::filesystem::file_size(file.path) - 10);
  const Journal cut = read_journal(file.path);
  EXPECT_TRUE(cut.cut_at);
  EXPECT_EQ(cut.strokes()[0].poses.size(), 70U);
  {
    JournalWriter writer(file.path);
    expect_same(writer.journal().strokes()[0], cut.strokes()[0]);
    writer.add_stroke(s);
  }
  const Journal after = read_journal(file.path);
  EXPECT_FALSE(after.cut_at);
  ASSERT_EQ(after.strokes().size(), 2U);
  expect_same(after.strokes()[1], s);
}

TEST(JournalWriter, BelongsToOneAtATimeAndEndsWithClose) {
  const TemporaryFile file("lock.rjournal");
  JournalWriter writer(file.path);
  EXPECT_THROW(JournalWriter second(file.path), std::runtime_error);
  writer.close();
  EXPECT_THROW(writer.add_note("a", "b"), std::runtime_error);
  EXPECT_TRUE(writer.journal().notes().empty());
  EXPECT_NO_THROW(JournalWriter second(file.path));
  EXPECT_THROW(JournalWriter nowhere("/nowhere/at/all.rjournal"), std::runtime_error);
}

TEST(JournalWriter, LeavesForeignFilesUnchanged) {
  const TemporaryFile file("alien.rjournal");
  base::write_file(file.path, std::string_view("my poems, not a journal"));
  EXPECT_THROW(JournalWriter writer(file.path), FormatError);
  EXPECT_EQ(base::read_file(file.path).size(), 23U);
}

/// Bytes of memory that the process has in use.
double resident() {
  std::ifstream statm("/proc/self/statm");
  double all = 0, pages = 0;
  statm >> all >> pages;
  return pages * static_cast<double>(sysconf(_SC_PAGESIZE));
}

TEST(JournalWriter, OfALongSessionKeepsNoRowsInMemory) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer keeps what was freed";
#endif
  const TemporaryFile file("long.rjournal");
  constexpr int kPieces = 5000, kRows = 50;  // 250 000 rows, 28 MB in memory
  JournalStroke piece = felt(kRows);
  double before = 0;
  {
    JournalWriter writer(file.path, JournalWriter::Keep::Rules);
    writer.add_tool(1, kBall);
    for (int k = 0; k < kPieces; ++k) {
      for (double& t : piece.times) t += 1e-3 * kRows;
      if (k % 100 == 0)
        writer.add_stroke(piece);
      else
        writer.extend_stroke(piece.rows());
      if (k == 100) before = resident();
    }
    EXPECT_LT(resident() - before, 4e6);
    EXPECT_EQ(writer.rules().counting(), kPieces / 100U);
    EXPECT_THROW(writer.journal(), std::runtime_error);
    EXPECT_EQ(error_of([&] { writer.extend_stroke(felt(2).rows()); }), "times, row 0: earlier than the one before");
  }
  std::printf("%.1f bytes a row in the file\n",
              static_cast<double>(std::filesystem::file_size(file.path)) / (kPieces * kRows));
  const Journal j = read_journal(file.path);
  ASSERT_EQ(j.strokes().size(), kPieces / 100U);
  EXPECT_EQ(j.strokes().back().removed.size(), 100U * kRows);
  // Going on keeps the checks.
  JournalWriter writer(file.path, JournalWriter::Keep::Rules);
  EXPECT_THROW(writer.extend_stroke(felt(2).rows()), std::invalid_argument);
  EXPECT_EQ(error_of([&] { writer.add_tool(1, "{}"); }), "tool 1 is another tool already: take another number");
}

TEST(JournalProgram, TakesFeedsFromTimes) {
  Journal j;
  j.set_stock({{{0, 0, 0}, {100, 60, 30}}, 0.25, "z", ""});
  j.add_tool(4, kBall);
  const Vec3 up(0, 0, 1);
  j.add_stroke({4,
                0.01,
                "",
                {{{0, 0, 5}, up},
                 {{0, 0, 5}, up},
                 {{10, 0, 5}, up},
                 {{10, 0, 5}, {0, 0.6, 0.8}},
                 {{11, 0, 5}, up},
                 {{12, 0, 5}, up},
                 {{13, 0, 5}, up}},
                {0, 1, 2, 3, 3, 1e9, 1e9 + 0.1}});
  const nc::Program p = to_program(j, {}, {{}, 5000, {}});
  ASSERT_EQ(p.size(), 9U);
  const double wanted[] = {0, 600, 600, 600, 600, 1e5, 1, 600, 0};
  for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR(p.feed()[k], wanted[k], 1e-3) << k;
  EXPECT_EQ(p.tool()[3], 4);
  EXPECT_EQ(p.spindle()[3], 5000);
  EXPECT_EQ(p.poses()[0].tip.z, 40) << "above the stock, not only above the stroke";
  EXPECT_EQ(to_program(j, {}, {250.0, 0, {}}).feed()[1], 250);
}

TEST(JournalProgram, NeedsAFeedIfThereAreNoTimes) {
  Journal j;
  j.add_tool(1, kBall);
  j.add_stroke({1, 0.01, "", {{{0, 0, 0}, {0, 0, 1}}, {{0, 0, 0}, {0, 0, 1}}}, {0, 1}});
  EXPECT_EQ(error_of([&] { to_program(j, {}); }), "stroke 0 never moves: give a feed");
  JournalStroke untimed = wavy(3);
  untimed.times.clear();
  Journal k;
  k.add_tool(1, kBall);
  k.add_stroke(untimed);
  EXPECT_EQ(error_of([&] { to_program(k, {}); }), "stroke 0 has no times: give a feed");
  EXPECT_TRUE(to_program(Journal(), {}).empty());
}

}  // namespace
}  // namespace riffler::session::journal_test
