#include "base/own_thread.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <optional>
#include <utility>

namespace riffler::base::own_thread_test {

TEST(OwnThread, ItsDestructorWaitsForIt) {
  std::atomic<bool> go{false};
  int done = 0;
  {
    const OwnThread thread([&] {
      go.wait(false);
      done = 1;
    });
    EXPECT_TRUE(thread.joinable());
    go = true;
    go.notify_one();
  }
  EXPECT_EQ(done, 1);
}

TEST(OwnThread, MayBeDestroyedAndAssignedToAfterAMoveFromIt) {
  int done = 0;
  std::optional<OwnThread> first(std::in_place, [&] { ++done; });
  OwnThread second(std::move(*first));
  EXPECT_FALSE(first->joinable());
  EXPECT_TRUE(second.joinable());
  first->join();
  second.join();
  EXPECT_EQ(done, 1);
  *first = OwnThread([&] { ++done; });
  EXPECT_TRUE(first->joinable());
  first->join();
  EXPECT_EQ(done, 2);
  OwnThread third(std::move(*first));
  first.reset();
  EXPECT_FALSE(third.joinable());
}

TEST(OwnThread, OneThatNeverRanIsJoinedAtOnce) {
  OwnThread thread;
  EXPECT_FALSE(thread.joinable());
  thread.join();
}

}  // namespace riffler::base::own_thread_test
