#include "base/background.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

#include "riffler/base/parallel.hpp"
#include "support/effort.hpp"

namespace riffler::base::background_test {
namespace {

using std::chrono::milliseconds;

/// Reports until it is cancelled.
void run_for_ever(const Progress& progress) {
  for (;;) {
    report(progress, 0.25);
    std::this_thread::yield();
  }
}

TEST(Background, WritesOfTheWorkAreVisibleOnceItIsDone) {
  std::vector<int> out;
  const std::thread::id here = std::this_thread::get_id();
  std::thread::id there = here;
  const Background work([&](const Progress& progress) {
    there = std::this_thread::get_id();
    for (int i = 0; i < 1000; ++i) {
      out.push_back(i);
      report(progress, i / 1000.0);
    }
  });
  while (!work.done()) std::this_thread::yield();
  EXPECT_EQ(out.size(), 1000);
  EXPECT_NE(there, here);
  EXPECT_EQ(work.share(), 1);
  EXPECT_NO_THROW(work.check());
  EXPECT_TRUE(work.wait(milliseconds(0)));
}

TEST(Background, ThrowsTheErrorOfTheWorkAtEveryRequest) {
  const Background work([](const Progress&) { throw std::invalid_argument("row 7"); });
  work.wait();
  for (int i = 0; i < 2; ++i) {
    try {
      work.check();
      FAIL();
    } catch (const std::invalid_argument& error) {
      EXPECT_STREQ(error.what(), "row 7");
    }
  }
  EXPECT_EQ(work.share(), 0);
}

TEST(Background, ACancelledOneThrowsCancelled) {
  Background work(run_for_ever);
  EXPECT_FALSE(work.wait(milliseconds(1)));
  EXPECT_FALSE(work.done());
  work.cancel();
  work.wait();
  EXPECT_THROW(work.check(), Cancelled);
  EXPECT_EQ(work.share(), 0.25);
}

TEST(Background, CancellingOneThatHasEndedChangesNothing) {
  Background work([](const Progress&) {});
  work.wait();
  work.cancel();
  EXPECT_NO_THROW(work.check());
  EXPECT_EQ(work.share(), 1);
}

TEST(Background, TheShareNeverFallsAndIsOneOnlyAtTheEnd) {
  std::atomic<int> step{0};
  const auto await = [&step](int k) {
    while (step < k) std::this_thread::yield();
  };
  const Background work([&](const Progress& progress) {
    for (const double share : {0.5, 0.25, 1.0}) {
      report(progress, share);
      ++step;
      const int asked = step + 1;
      await(asked);
    }
  });
  const double expected[] = {0.5, 0.5, 1 - 1e-9};
  for (int k = 0; k < 3; ++k) {
    await(2 * k + 1);
    EXPECT_EQ(work.share(), expected[k]);
    ++step;
  }
  work.wait();
  EXPECT_EQ(work.share(), 1);
}

TEST(Background, ObjectsOfTheWorkAreFreedWhenItEnds) {
  const auto held = std::make_shared<int>(1);
  const Background work([held](const Progress&) {});
  work.wait();
  EXPECT_EQ(held.use_count(), 1);
}

TEST(Background, AThousandTasksMayBeDroppedOrCancelledAtAnyTime) {
  std::atomic<int> ended{0};
  struct Count {
    std::atomic<int>& ended;
    ~Count() { ++ended; }
  };
  constexpr int kTasks = test::cases(1000);
  for (int i = 0; i < kTasks; ++i) {
    Background work([&ended, i](const Progress& progress) {
      const Count count{ended};
      std::vector<double> sums(64);
      for (;;)
        parallel_for(
            64, 1 + i % 7,
            [&](std::size_t begin, std::size_t end) {
              for (std::size_t k = begin; k < end; ++k) sums[k] += static_cast<double>(k);
            },
            progress);
    });
    for (int k = 0; k < i % 5; ++k) std::this_thread::yield();
    EXPECT_LE(work.share(), 1);
    if (i % 3 == 0) work.cancel();
    if (i % 2 == 0) std::thread([&work] { work.cancel(), work.wait(); }).join();
  }
  EXPECT_EQ(ended, kTasks);
}

}  // namespace
}  // namespace riffler::base::background_test
