#include "riffler/nc/program_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>
#include <zlib.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>

#include "base/io.hpp"
#include "riffler/base/error.hpp"
#include "riffler/tool/cutters.hpp"
#include "stress/random.hpp"
#include "stress/thread_count.hpp"

namespace riffler::nc::program_file_test {
namespace {

using File = std::vector<std::uint8_t>;

Program sample(int rows, std::uint64_t seed = 81) {
  stress::Random random(seed);
  Program p;
  for (int k = 0; k < rows; ++k) {
    Move move{{{random.uniform(-90, 90), std::sin(k * 0.01), -1e-3 * k}, random.direction()}, 0, 0, 1 + k / 40, 0};
    move.rapid = random.one_in(9);
    move.feed = move.rapid ? 0 : random.power_of_ten(-3, 4);
    move.spindle = random.one_in(3) ? -8000.5 : 12000;
    move.line = random.one_in(2) ? k : 0;
    p.append(move);
  }
  p.tools.emplace(1, cutters::ball(6, 30).with_shank({{30, 3, 40, 4}}).with_holder({{40, 9, 60, 9}, {60, 20, 90, 20}}));
  p.tools.emplace(2, cutters::taper(1, 0.2, 12, 60).named("taper \xC3\xA9"));
  p.tools.emplace(70, Tool("profile", {}, tool::Profile({{{2, 0}, {}}, {{3, 1}, Vec2{2, 1}}, {{3, 20}, {}}})));
  p.provenance = {{"part", "Ünal's"}, {"", ""}, {"part", "twice"}};
  return p;
}

std::uint64_t bits(double x) {
  return std::bit_cast<std::uint64_t>(x);
}

void expect_same(const Tool& a, const Tool& b) {
  EXPECT_EQ(a.name(), b.name());
  EXPECT_EQ(a.kind(), b.kind());
  EXPECT_EQ(a.parameters(), b.parameters());
  ASSERT_EQ(a.profile().segments().size(), b.profile().segments().size());
  for (std::size_t k = 0; k < a.profile().segments().size(); ++k) {
    EXPECT_EQ(a.profile().segments()[k].to, b.profile().segments()[k].to);
    EXPECT_EQ(a.profile().segments()[k].centre, b.profile().segments()[k].centre);
  }
  for (const auto pieces : {&Tool::shank, &Tool::holder}) {
    ASSERT_EQ((a.*pieces)().size(), (b.*pieces)().size());
    for (std::size_t k = 0; k < (a.*pieces)().size(); ++k)
      EXPECT_EQ(std::memcmp(&(a.*pieces)()[k], &(b.*pieces)()[k], sizeof(tool::Frustum)), 0);
  }
}

void expect_same(const Program& a, const Program& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t row = 0; row < a.size(); ++row) {
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(bits(a.poses()[row].tip[k]), bits(b.poses()[row].tip[k]));
      EXPECT_EQ(bits(a.poses()[row].axis[k]), bits(b.poses()[row].axis[k]));
    }
    EXPECT_EQ(bits(a.feed()[row]), bits(b.feed()[row]));
    EXPECT_EQ(bits(a.spindle()[row]), bits(b.spindle()[row]));
  }
  EXPECT_EQ(a.tool(), b.tool());
  EXPECT_EQ(a.line(), b.line());
  EXPECT_EQ(a.rapid(), b.rapid());
  EXPECT_EQ(a.provenance, b.provenance);
  ASSERT_EQ(a.tools.size(), b.tools.size());
  for (auto i = a.tools.begin(), j = b.tools.begin(); i != a.tools.end(); ++i, ++j) {
    EXPECT_EQ(i->first, j->first);
    expect_same(i->second, j->second);
  }
}

/// What the reader says of the file, or nothing.
std::string error_of(const File& bytes) {
  try {
    parse_program(bytes, "p.rprog");
  } catch (const FormatError& e) {
    return e.what();
  }
  return "";
}

template <class T>
void set(File& bytes, std::size_t at, T value) {
  std::memcpy(&bytes[at], &value, sizeof value);
}

/// Checksums as if the damage had been written.
void forge(File& bytes) {
  set(bytes, 36, static_cast<std::uint32_t>(crc32_z(0, bytes.data(), 36)));
  for (std::size_t at = 40; at + 20 <= bytes.size();) {
    std::uint64_t length;
    std::memcpy(&length, &bytes[at + 8], 8);
    if (length > bytes.size() - at - 20) return;
    const auto head = crc32_z(0, &bytes[at], 16);
    set(bytes, at + 16, static_cast<std::uint32_t>(length ? crc32_z(head, &bytes[at + 20], length) : head));
    at += 20 + length;
  }
}

TEST(ProgramFile, RestoresEveryProgramToTheBit) {
  for (const int rows : {0, 1, 2, 300, 32768, 32769, 80'000}) {
    const Program p = sample(rows);
    const File bytes = to_bytes(p);
    const Program back = parse_program(bytes, "p");
    expect_same(p, back);
    EXPECT_EQ(bytes, to_bytes(back));
  }
  expect_same(Program(), parse_program(to_bytes(Program()), "p"));
}

TEST(ProgramFile, KeepsEveryDoubleThatARowMayHold) {
  Program p;
  const double tiny = 5e-324;
  p.append({{{-0.0, tiny, 1e6}, {0, 0, 1}}, 1e9, -0.0, 0, 0, false});
  p.append({{{1e-300, -1e6, 0.1 + 0.2}, {-0.0, tiny, -1}}, tiny, -1e7, 99'999'999, 2'000'000'000, false});
  p.append({{{0, 0, 0}, glm::normalize(Vec3(1, 2, 3))}, 0, 1 / 3.0, 5, -7, true});
  expect_same(p, parse_program(to_bytes(p), "p"));
}

TEST(ProgramFile, IsTheSameForAnyNumberOfThreads) {
  const Program p = sample(100'000);
  std::vector<File> files;
  for (const char* threads : {"1", "2", "5"}) {
    const stress::ThreadCount set(threads);
    files.push_back(to_bytes(p));
    expect_same(p, parse_program(files.back(), "p"));
  }
  EXPECT_EQ(files[0], files[1]);
  EXPECT_EQ(files[0], files[2]);
}

TEST(ProgramFile, IsSmallerThanItsDoubles) {
  Program p;
  for (int k = 0; k < 100'000; ++k) {
    const double t = 1e-4 * k;
    p.append({{{50 * t, 20 * std::sin(3 * t), -t}, {0, 0, 1}}, 800, 12000, 1, k, false});
  }
  EXPECT_LT(to_bytes(p).size(), 100'000 * 3 * sizeof(double));
}

TEST(ProgramFile, AnyDamagedByteIsFound) {
  const File bytes = to_bytes(sample(60));
  for (std::size_t at = 0; at < bytes.size(); ++at)
    for (const int flip : {0x01, 0x80}) {
      File damaged = bytes;
      damaged[at] ^= static_cast<std::uint8_t>(flip);
      EXPECT_EQ(error_of(damaged).rfind("p.rprog, byte ", 0), 0U) << "byte " << at << " went unnoticed";
    }
}

TEST(ProgramFile, TruncatedOrLengthenedAnywhereIsNoProgram) {
  File bytes = to_bytes(sample(60));
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_NE(error_of({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)}), "") << size;
  const std::size_t whole = bytes.size();
  bytes.push_back(0);
  EXPECT_EQ(error_of(bytes), "p.rprog, byte " + std::to_string(whole) + ": there is more after the file's end");
}

TEST(ProgramFile, ErrorsNameTheFaultAndItsPlace) {
  const File good = to_bytes(sample(60));
  const auto changed = [&](std::size_t at, auto value) {
    File bytes = good;
    set(bytes, at, value);
    forge(bytes);
    return error_of(bytes);
  };
  EXPECT_EQ(error_of({}), "p.rprog, byte 0: not a .rprog file (its first eight bytes differ)");
  EXPECT_EQ(changed(8, 2U), "p.rprog, byte 8: version 2; this program reads version 1");
  EXPECT_EQ(changed(24, std::uint64_t{61}), "p.rprog, byte 24: the header announces 61 rows, the records hold 60");
  EXPECT_EQ(changed(32, 4U), "p.rprog, byte 44: the header announces another number of notes");
  EXPECT_EQ(changed(12, 2U), "p.rprog, byte " + std::to_string([&] {
                               std::size_t at = 40;
                               for (int record = 0; record < 3; ++record) {
                                 std::uint64_t length;
                                 std::memcpy(&length, &good[at + 8], 8);
                                 at += 20 + length;
                               }
                               return at;
                             }()) +
                                 ": a record of another kind than expected");
  EXPECT_EQ(changed(48, std::uint64_t{1} << 60), "p.rprog, byte 48: the record is longer than the rest of the file");
}

/// Damage under right checksums: programs or errors, nothing else, and no memory that the file does not account for.
TEST(ProgramFile, SurvivesThousandsOfForgedFiles) {
  const File good = to_bytes(sample(60));
  stress::Random random(82);
  int read = 0, refused = 0;
  for (int round = 0; round < 5000; ++round) {
    File bytes = good;
    for (int k = random.below(4); k >= 0; --k) {
      const std::size_t at = random.bits() % bytes.size();
      if (random.one_in(3) && at + 4 < bytes.size())
        set(bytes, at, static_cast<std::uint32_t>(random.bits()));
      else
        bytes[at] = static_cast<std::uint8_t>(random.bits());
    }
    forge(bytes);
    try {
      parse_program(bytes, "p");
      ++read;
    } catch (const FormatError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 1000);
  EXPECT_GT(read, 10);  // notes and names may be anything
}

TEST(ProgramFile, IsWrittenWholeOrNotAtAll) {
  const auto folder = std::filesystem::temp_directory_path() / ("riffler_rprog_" + std::to_string(getpid()));
  std::filesystem::create_directory(folder);
  const Program p = sample(100);
  save_program(p, folder / "p.rprog");
  expect_same(p, load_program(folder / "p.rprog"));
  EXPECT_THROW(save_program(p, folder / "p.rprog", [](double) { return false; }), Cancelled);
  EXPECT_THROW(load_program(folder / "p.rprog", [](double) { return false; }), Cancelled);
  expect_same(p, load_program(folder / "p.rprog"));
  EXPECT_THROW(save_program(p, folder / "none" / "p.rprog"), std::runtime_error);
  EXPECT_THROW(load_program(folder / "q.rprog"), FormatError);
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder)) ++files;
  EXPECT_EQ(files, 1U);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace riffler::nc::program_file_test
