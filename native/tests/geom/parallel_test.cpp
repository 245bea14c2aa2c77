#include "geom/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <thread>
#include <vector>

namespace riffler {
namespace {

TEST(Parallel, ACallWithinACallStaysOnItsThread) {
  setenv("RIFFLER_THREADS", "4", 1);
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
  unsetenv("RIFFLER_THREADS");
}

}  // namespace
}  // namespace riffler
