#include "riffler/dexel/file/file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <zlib.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>

#include "base/io.hpp"
#include "base/planes.hpp"
#include "dexel/volumes.hpp"
#include "riffler/base/error.hpp"
#include "riffler/dexel/boolean.hpp"

namespace riffler::dexel::file_test {
namespace {

using namespace test;
using Bytes = std::vector<std::uint8_t>;

std::string error_of(const Bytes& bytes) {
  try {
    from_bytes(bytes, "part.rvol");
  } catch (const FormatError& e) {
    return e.what();
  }
  return "";
}

// Offsets as the format's description has them, not taken from the code under test.
constexpr std::size_t kHeader = 96, kChunkHeader = 24;

template <class T>
T at(const Bytes& bytes, std::size_t k) {
  T value;
  std::memcpy(&value, bytes.data() + k, sizeof value);
  return value;
}

template <class T>
void set(Bytes& bytes, std::size_t k, T value) {
  std::memcpy(bytes.data() + k, &value, sizeof value);
}

/// Makes length and checksums right again, as far as the chunks can still be followed.
void repair(Bytes& bytes) {
  if (bytes.size() < kHeader) return;
  set<std::uint64_t>(bytes, 16, bytes.size());
  set(bytes, 92, static_cast<std::uint32_t>(crc32_z(0, bytes.data(), 92)));
  for (std::size_t k = kHeader; bytes.size() - k >= kChunkHeader;) {
    const auto length = at<std::uint64_t>(bytes, k + 12);
    if (length > bytes.size() - k - kChunkHeader) return;
    const auto head = crc32_z(0, bytes.data() + k, 20);
    set(bytes, k + 20, static_cast<std::uint32_t>(crc32_z(head, bytes.data() + k + kChunkHeader, length)));
    k += kChunkHeader + length;
  }
}

TEST(Planes, OfAnyNumbersRoundTrip) {
  std::mt19937_64 random(7);
  const std::vector<std::function<std::uint64_t(std::size_t)>> columns{
      [](std::size_t) { return 0; },
      [](std::size_t k) { return k; },
      [](std::size_t k) { return ~std::uint64_t{0} - k * k; },
      [&](std::size_t) { return random(); },
      [&](std::size_t) { return random() % 3; },
      [](std::size_t k) { return k % 2 ? ~std::uint64_t{0} : std::uint64_t{1} << 63; }};
  for (const auto& column : columns)
    for (const std::size_t n : {0UL, 1UL, 2UL, 3UL, 1000UL, 70000UL}) {
      std::vector<std::uint64_t> a(n);
      for (std::size_t k = 0; k < n; ++k) a[k] = column(k);
      const std::vector<std::uint32_t> b(a.begin(), a.end());
      const std::vector<std::uint16_t> c(a.begin(), a.end());
      Bytes bytes;
      base::PlaneWriter out(bytes);
      out.column(a), out.column(b), out.column(c);
      const std::string name = "x";
      base::PlaneReader in(bytes, 0, name);
      EXPECT_EQ(in.column64(n), a);
      EXPECT_EQ(in.column32(n), b);
      EXPECT_EQ(in.column16(n), c);
      in.finish();
      EXPECT_LE(bytes.size(), 14 * (n + 1));
    }
}

TEST(File, RestoresEveryVolume) {
  std::vector<Volume> volumes{Volume(lattice_frame("z")), Volume::block(lattice_frame("xyz")),
                              Volume::block({{{-3, 1e3, 0.1}, {-2.5, 1e3 + 7, 9}}, 0.3, "y"}),
                              wavy_volume({{{0, 0, 0}, {50, 30, 20}}, 0.4, "xyz"})};
  for (unsigned seed = 1; seed < 6; ++seed) volumes.push_back(random_volume(lattice_frame("xyz", 0.3), seed));
  for (const Volume& v : volumes) {
    const Volume loaded = from_bytes(to_bytes(v), "x.rvol");
    EXPECT_TRUE(same_rays(loaded, v));
    for (std::size_t g = 0; g < v.grids().size(); ++g) {
      EXPECT_EQ(loaded.grids()[g].has_normals(), v.grids()[g].has_normals());
      for (std::size_t t = 0; t < v.grids()[g].tile_count(); ++t)
        for (const Span& s : loaded.grids()[g].tile(t).spans) {
          ASSERT_LE(loaded.grids()[g].tile(t).reach.near, s.near);
          ASSERT_GE(loaded.grids()[g].tile(t).reach.far, s.far);
        }
    }
  }
}

TEST(File, StoresSharedAndEqualTilesOnce) {
  // 10 000 equal tiles with 10 million rays: a page.
  EXPECT_LT(to_bytes(Volume::block({{{0, 0, 0}, {320, 320, 10}}, 0.1, "z"})).size(), 3000U);
  // Equal volumes are equal files, however they came to be.
  const Frame frame = lattice_frame("z", 0.2);
  const Volume box = Volume::block(frame), hole = random_volume(frame, 4);
  Volume refilled = box;
  apply(Boolean::Subtract, refilled, hole);
  Volume again = refilled;
  EXPECT_NE(to_bytes(refilled), to_bytes(box));
  apply(Boolean::Add, refilled, hole);
  apply(Boolean::Add, refilled, box);
  EXPECT_EQ(to_bytes(refilled), to_bytes(box));
  const Bytes bytes = to_bytes(again);
  const Volume loaded = from_bytes(bytes, "x.rvol");
  EXPECT_EQ(to_bytes(loaded), bytes);
  EXPECT_LE(loaded.nbytes(), again.nbytes());
}

TEST(File, IsTheSameForAnyNumberOfThreads) {
  const Volume v = wavy_volume({{{0, 0, 0}, {60, 60, 20}}, 0.2, "xyz"});
  const char* kept = std::getenv("RIFFLER_THREADS");
  const std::string old = kept ? kept : "";
  setenv("RIFFLER_THREADS", "1", 1);
  const Bytes one = to_bytes(v);
  EXPECT_TRUE(same_rays(from_bytes(one, "x"), v));
  setenv("RIFFLER_THREADS", "4", 1);
  EXPECT_EQ(to_bytes(v), one);
  EXPECT_TRUE(same_rays(from_bytes(one, "x"), v));
  old.empty() ? unsetenv("RIFFLER_THREADS") : setenv("RIFFLER_THREADS", old.c_str(), 1);
}

TEST(File, ErrorsNameTheFaultAndItsPlace) {
  const Bytes good = to_bytes(random_volume(lattice_frame("xyz"), 2));
  const auto has = [](const std::string& text, const char* part) {
    return text.find("part.rvol") == 0 && text.find(part) != std::string::npos;
  };
  EXPECT_EQ(error_of(good), "");
  EXPECT_PRED2(has, error_of({}), "byte 0: not a .rvol");
  EXPECT_PRED2(has, error_of(Bytes(200, 'x')), "byte 0: not a .rvol");
  EXPECT_PRED2(has, error_of(Bytes(good.begin(), good.begin() + 50)), "byte 50");
  EXPECT_PRED2(has, error_of(Bytes(good.begin(), good.end() - 1)), "the file ends here");
  Bytes longer = good;
  longer.push_back(0);
  EXPECT_PRED2(has, error_of(longer), "data after the file's end");
  repair(longer);
  EXPECT_PRED2(has, error_of(longer), "the file ends where a chunk should begin");
  Bytes other = good;
  other[8] = 2;
  EXPECT_PRED2(has, error_of(other), "byte 8: version 2");
  other = good;
  other[30] ^= 1;
  EXPECT_PRED2(has, error_of(other), "header's checksum");
  other = good;
  other[good.size() - 1] ^= 1;
  EXPECT_PRED2(has, error_of(other), "chunk's checksum");
  // Frames that make no sense, with right checksums.
  for (const double bad : {0.0, -1.0, std::nan(""), 1e-300, 1e-9, std::numeric_limits<double>::infinity()}) {
    other = good;
    set(other, 72, bad);
    repair(other);
    EXPECT_NE(error_of(other), "") << bad;
  }
  other = good;
  set(other, 12, std::uint32_t{'q'});
  repair(other);
  EXPECT_PRED2(has, error_of(other), "directions");
  other = good;
  set(other, 80, std::uint64_t{1} << 60);
  repair(other);
  EXPECT_PRED2(has, error_of(other), "byte 80");
}

TEST(File, RefusesSpansThatAVolumeCannotHave) {
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  const std::vector<std::vector<Span>> bad{{{5, 4}},         {{4, 4}},         {{nan, 4}},       {{4, nan}},
                                           {{1, inf}},       {{-inf, 3}},      {{1, 11}},        {{-1, 3}},
                                           {{1, 3}, {2, 4}}, {{1, 3}, {3, 4}}, {{5, 6}, {1, 2}}, {{1, 5}, {2, 3}}};
  const auto volume = [](const std::vector<Span>& spans, int ray) {
    Volume v({{{0, 0, 0}, {40, 5, 10}}, 1, "z"});  // 2 × 1 tiles, the second with 8 × 5 rays
    TileBuilder builder(false);
    while (builder.rays() < ray) builder.next_ray();
    for (const Span& s : spans) builder.add(s);
    v.grids()[0].set_tile(1, builder.finish());
    return v;
  };
  EXPECT_EQ(error_of(to_bytes(volume({{0, 3}, {4, 10}}, 3))), "");
  for (const auto& spans : bad) EXPECT_NE(error_of(to_bytes(volume(spans, 3))), "") << spans[0].near;
  EXPECT_NE(error_of(to_bytes(volume({{1, 2}}, 5))), "") << "a ray beyond the grid in v";
  EXPECT_NE(error_of(to_bytes(volume({{1, 2}}, 8 * 32))), "") << "a ray beyond the grid in u";
}

/// One random change: bytes set, flipped, cut out, doubled, swapped in from elsewhere, or the end cut off.
Bytes mutate(Bytes bytes, std::mt19937& random) {
  const auto any = [&](std::size_t n) { return n == 0 ? 0 : random() % n; };
  for (unsigned rounds = 1 + random() % 4; rounds > 0 && !bytes.empty(); --rounds) {
    // Half the changes hit headers, where they do most.
    const std::size_t k = random() % 2 ? any(bytes.size()) : any(std::min<std::size_t>(bytes.size(), 160));
    const std::size_t n = std::min(bytes.size() - k, any(40) + 1);
    const auto from = bytes.begin() + static_cast<std::ptrdiff_t>(k);
    switch (random() % 8) {
      case 0:
        bytes[k] = static_cast<std::uint8_t>(random());
        break;
      case 1:
        bytes[k] = static_cast<std::uint8_t>(bytes[k] ^ (1U << any(8)));
        break;
      case 2:
        bytes.erase(from, from + static_cast<std::ptrdiff_t>(n));
        break;
      case 3: {
        const Bytes copy(from, from + static_cast<std::ptrdiff_t>(n));
        bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(any(bytes.size())), copy.begin(), copy.end());
        break;
      }
      case 4:
        bytes.resize(k);
        break;
      case 5:
        std::fill_n(from, n, random() % 2 ? 0xFF : 0x00);
        break;
      case 6:
        if (bytes.size() - k >= 4) set(bytes, k, static_cast<std::uint32_t>(random()));
        break;
      default:
        if (bytes.size() - k >= 8) set(bytes, k, std::uint64_t{1} << any(64));
    }
  }
  return bytes;
}

long peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss / 1024;
}

TEST(File, SurvivesThousandsOfDamagedFiles) {
  std::vector<Bytes> seeds{to_bytes(random_volume({{{0, 0, 0}, {24, 24, 24}}, 0.6, "xyz"}, 1)),
                           to_bytes(Volume::block({{{0, 0, 0}, {9, 9, 9}}, 0.1, "z"})),
                           to_bytes(wavy_volume({{{0, 0, 0}, {9, 9, 9}}, 0.2, "xyz"}))};
  std::mt19937 random(20240611);
  const long before = peak_megabytes();
  int refused = 0, read = 0;
  for (int k = 0; k < 9000; ++k) {
    Bytes bytes = mutate(seeds[k % seeds.size()], random);
    if (k % 3 != 0) repair(bytes);  // else the checksums would refuse nearly all
    try {
      const Volume v = from_bytes(bytes, "x.rvol");
      // What is accepted is a sound volume: it can be written and read again.
      ASSERT_TRUE(same_rays(from_bytes(to_bytes(v), "x.rvol"), v));
      ++read;
    } catch (const FormatError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 4000);
  EXPECT_GT(read, 10);
  EXPECT_LT(peak_megabytes() - before, 400);  // the address sanitizer keeps 256 of what was freed
}

TEST(File, IsWrittenWholeOrNotAtAll) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "riffler_file_test";
  std::filesystem::create_directories(folder);
  const std::filesystem::path path = folder / "a.rvol";
  const Volume v = random_volume(lattice_frame("z"), 5);
  save(v, path);
  EXPECT_TRUE(same_rays(load(path), v));
  const Bytes before = base::read_file(path);
  EXPECT_THROW(save(Volume::block(lattice_frame("xyz")), path, [](double) { return false; }), Cancelled);
  EXPECT_EQ(base::read_file(path), before);
  EXPECT_THROW(load(path, [](double) { return false; }), Cancelled);
  EXPECT_THROW(load(folder / "none.rvol"), FormatError);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace riffler::dexel::file_test
