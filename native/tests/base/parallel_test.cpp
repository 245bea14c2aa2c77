#include "riffler/base/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include "support/set_environment.hpp"

namespace riffler::base::parallel_test {
namespace {

TEST(Parallel, ACallWithinACallStaysOnItsThread) {
  const test::SetEnvironment threads("RIFFLER_THREADS", "4");
  std::atomic<int> elsewhere{0}, done{0};
  parallel_for(16, 1, [&](std::size_t, std::size_t) {
    const std::thread::id here = std::this_thread::get_id();
    parallel_for(8, 1, [&](std::size_t, std::size_t) { elsewhere += std::this_thread::get_id() != here, ++done; });
  });
  EXPECT_EQ(elsewhere, 0);
  EXPECT_EQ(done, 16 * 8);
  // After it, and after one that threw, calls use all threads again.
  EXPECT_THROW(parallel_for(16, 1, [](std::size_t, std::size_t) { throw std::runtime_error("no"); }),
               std::runtime_error);
  std::vector<std::thread::id> ids(4);
  std::atomic<int> waiting{0};
  parallel_for(4, 1, [&](std::size_t k, std::size_t) {
    ids[k] = std::this_thread::get_id(), ++waiting;
    while (waiting < 4) std::this_thread::yield();  // each chunk on a thread of its own, or never
  });
  for (int a = 0; a < 4; ++a)
    for (int b = 0; b < a; ++b) EXPECT_NE(ids[a], ids[b]);
}

TEST(Parallel, TheLastReportedShareIsOneEvenIfHelpersFinishTheWork) {
  const test::SetEnvironment threads("RIFFLER_THREADS", "2");
  constexpr int kChunks = 64;
  for (const bool cancel : {false, true}) {
    std::atomic<int> done{0};
    std::atomic<bool> told{false};
    std::vector<double> shares;
    const auto body = [&, caller = std::this_thread::get_id()](std::size_t, std::size_t) {
      while (!told && std::this_thread::get_id() != caller) std::this_thread::yield();
      ++done;
    };
    const auto progress = [&](double share) {
      shares.push_back(share), told = true;
      while (done < kChunks) std::this_thread::yield();  // the helper does the rest
      return !(cancel && share == 1);
    };
    if (cancel)
      EXPECT_THROW(parallel_for(kChunks, 1, body, progress), Cancelled);
    else
      parallel_for(kChunks, 1, body, progress);
    ASSERT_EQ(shares.size(), 2);
    EXPECT_LT(shares[0], 0.1);
    EXPECT_EQ(shares[1], 1);
  }
}

TEST(Parallel, ALongBodySeesThatItsCallIsCancelled) {
  const test::SetEnvironment threads("RIFFLER_THREADS", "2");
  still_wanted();  // outside of any call
  const auto for_ever = [](std::size_t, std::size_t) {
    while (true) still_wanted();
  };
  int asked = 0;
  EXPECT_THROW(parallel_for(2, 1, for_ever, [&](double) { return ++asked < 100; }), Cancelled);
  EXPECT_GE(asked, 100);
  // Another body has failed, in a call within this one.
  EXPECT_THROW(parallel_for(2, 1,
                            [&](std::size_t k, std::size_t) {
                              if (k == 1) throw std::runtime_error("no");
                              parallel_for(1, 1, for_ever);
                            }),
               std::runtime_error);
}

}  // namespace
}  // namespace riffler::base::parallel_test
