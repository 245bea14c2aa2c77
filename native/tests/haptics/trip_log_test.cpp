#include "riffler/haptics/trip_log.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

namespace riffler::haptics::trip_log_test {
namespace {

Trip numbered(std::uint64_t k) {
  const double x = static_cast<double>(k);
  return {x, static_cast<ForceState>(k % kForceStates), static_cast<Cause>(k % kCauses), 3 * x};
}

void expect_numbered(const Trip& t) {
  const Trip wanted = numbered(static_cast<std::uint64_t>(t.time));
  EXPECT_EQ(t.state, wanted.state);
  EXPECT_EQ(t.cause, wanted.cause);
  EXPECT_EQ(t.value, wanted.value);
}

TEST(TripLog, GivesEachTripOnceAndInOrder) {
  TripLog log;
  std::uint64_t from = 0;
  std::vector<Trip> out(10);
  EXPECT_EQ(log.read(from, out), 0u);
  for (std::uint64_t k = 0; k < 15; ++k) log.add(numbered(k));
  ASSERT_EQ(log.read(from, out), 10u);
  EXPECT_EQ(out[9].time, 9);
  ASSERT_EQ(log.read(from, out), 5u);
  EXPECT_EQ(out[0].time, 10);
  EXPECT_EQ(log.read(from, out), 0u);
  EXPECT_EQ(log.count(), 15u);
}

TEST(TripLog, HoldsTheLastOnesAndCountsAll) {
  TripLog log;
  for (std::uint64_t k = 0; k < 1000; ++k) log.add(numbered(k));
  std::uint64_t from = 0;
  std::vector<Trip> out(1000);
  ASSERT_EQ(log.read(from, out), TripLog::kCapacity);
  EXPECT_EQ(out[0].time, 1000.0 - TripLog::kCapacity);
  EXPECT_EQ(from, 1000u);
  EXPECT_EQ(log.count(), 1000u);
}

TEST(TripLog, NeverShowsAHalfWrittenTripToAnotherThread) {
  TripLog log;
  std::atomic<bool> done{false};
  constexpr std::uint64_t kTrips = 200'000;
  std::uint64_t seen = 0;
  std::thread reader([&] {
    std::uint64_t from = 0;
    std::vector<Trip> out(64);
    double last = -1;
    for (bool over = false; !over;) {
      over = done.load();
      for (std::size_t n = log.read(from, out); n > 0; n = log.read(from, out))
        for (std::size_t k = 0; k < n; ++k, ++seen) {
          expect_numbered(out[k]);
          EXPECT_GT(out[k].time, last);
          last = out[k].time;
        }
    }
  });
  for (std::uint64_t k = 0; k < kTrips; ++k) log.add(numbered(k));
  done = true;
  reader.join();
  EXPECT_GT(seen, 0u);
  EXPECT_LE(seen, kTrips);
}

}  // namespace
}  // namespace riffler::haptics::trip_log_test
