// Bytes of any kind: a report that encodes to the same bytes again, or a refusal that leaves everything as it was.
#include <gtest/gtest.h>

#include <cstring>

#include "device/pens.hpp"

namespace riffler::device::protocol_fuzz_test {
namespace {

/// Damages a report in one of several forms.
void damage(Bytes& bytes, stress::Random& random) {
  const auto at = [&] { return static_cast<std::size_t>(random.below(static_cast<int>(bytes.size()))); };
  if (bytes.empty()) bytes.push_back(0);
  switch (random.below(7)) {
    case 0:
      bytes[at()] = static_cast<std::uint8_t>(random.bits());
      break;
    case 1:
      bytes[at()] ^= static_cast<std::uint8_t>(1U << random.below(8));
      break;
    case 2:
      bytes.resize(at());
      break;
    case 3:
      bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at()), static_cast<std::uint8_t>(random.bits()));
      break;
    case 4:  // two reports merged, and a part of them
      bytes.insert(bytes.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(at()));
      break;
    case 5:
      std::fill(bytes.begin() + static_cast<std::ptrdiff_t>(at()), bytes.end(), std::uint8_t{0});
      break;
    default:
      for (std::size_t k = at(), end = std::min(bytes.size(), k + 4); k < end; ++k)
        bytes[k] = random.one_in(3) ? 0xFF : static_cast<std::uint8_t>(random.bits());
  }
  bytes.shrink_to_fit();  // an address sanitizer sees any byte read beyond the end
}

template <class T>
void fuzz(T (*make)(stress::Random&), std::uint64_t seed) {
  stress::Random random(seed);
  int read = 0, refused = 0;
  for (int round = 0; round < 200'000; ++round) {
    Bytes bytes = encoded(make(random));
    if (round % 4 == 0) {
      for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.bits());
      if (random.one_in(2)) bytes[0] = static_cast<std::uint8_t>(1 + random.below(4));
    }
    for (int n = random.below(3); n >= 0; --n) damage(bytes, random);
    T report;
    std::memset(&report, 0x5A, sizeof report);
    T before = report;
    const riffler_pen_result result = decode(bytes, report);
    if (result == RIFFLER_PEN_OK) {
      ++read;
      ASSERT_EQ(encoded(report), bytes);
      continue;
    }
    ++refused;
    ASSERT_LT(result, RIFFLER_PEN_OLD_SEQUENCE);
    if constexpr (std::is_same_v<T, riffler_pen_identity>) {
      if (result == RIFFLER_PEN_OTHER_VERSION) {
        before.major = report.major;
        before.minor = report.minor;
      }
    }
    ASSERT_EQ(std::memcmp(&report, &before, sizeof report), 0) << "a refused report was written to";
  }
  EXPECT_GT(read, 1000) << "the damage is too great to test what is read";
  EXPECT_GT(refused, 10'000);
}

TEST(PenProtocolFuzz, InputReports) {
  fuzz<riffler_pen_input>(random_input, 11);
}
TEST(PenProtocolFuzz, OutputReports) {
  fuzz<riffler_pen_output>(random_output, 12);
}
TEST(PenProtocolFuzz, IdentityReports) {
  fuzz<riffler_pen_identity>(random_identity, 13);
}
TEST(PenProtocolFuzz, LimitsReports) {
  fuzz<riffler_pen_limits>(random_limits, 14);
}

/// What a host may do wrong reaches the motors only within the limits, and never keeps the watchdog quiet.
TEST(PenProtocolFuzz, APenThatPushesSurvivesAnyReport) {
  stress::Random random(15);
  int taken = 0, refused = 0;
  for (int round = 0; round < 200; ++round) {
    Pen pen;
    pen.activate({300, -200, 100, 0, 50, -50});
    ASSERT_EQ(pen.state(), RIFFLER_PEN_ACTIVE);
    std::uint32_t age = 0;
    for (int k = 0; k < 500; ++k) {
      riffler_pen_output report = random_output(random);
      report.sequence = static_cast<std::uint16_t>(pen.sequence + random.below(4) - 1);
      Bytes bytes = encoded(report);
      for (int n = random.below(3); n > 0; --n) damage(bytes, random);
      age += 1000;
      if (riffler_pen_receive(&pen.pen, bytes.data(), bytes.size()) == RIFFLER_PEN_OK) {
        age = 0;
        pen.sequence = pen.pen.link.newest.sequence;
        ++taken;
      } else {
        ++refused;
      }
      pen.step();
      const int most = riffler_pen_pushes(pen.state()) ? 1500 : 0;
      for (const int current : pen.currents()) ASSERT_LE(std::abs(current), most);
      ASSERT_TRUE(age < 20'000 || !riffler_pen_pushes(pen.state()));
    }
  }
  EXPECT_GT(taken, 10'000);
  EXPECT_GT(refused, 10'000);
}

TEST(PenProtocolFuzz, RefusedReportsDoNotFeedTheWatchdog) {
  stress::Random random(16);
  Pen pen;
  pen.activate({300, 0, 0, 0, 0, 0});
  for (int k = 0; k < 19; ++k) {
    Bytes bytes(static_cast<std::size_t>(random.below(70)));
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.bits());
    if (bytes.size() == RIFFLER_PEN_OUTPUT_SIZE) bytes[0] = 9;
    ASSERT_NE(riffler_pen_receive(&pen.pen, bytes.data(), bytes.size()), RIFFLER_PEN_OK);
    pen.step();
    ASSERT_EQ(pen.state(), RIFFLER_PEN_ACTIVE);
  }
  pen.step();
  EXPECT_EQ(pen.fault(), RIFFLER_PEN_WATCHDOG);
  EXPECT_EQ(pen.pen.link.refused_count, 19);
}

}  // namespace
}  // namespace riffler::device::protocol_fuzz_test
