#include "base/memory.hpp"

#include <gtest/gtest.h>

#include "support/error_of.hpp"

namespace riffler::base::memory_test {
namespace {

TEST(Memory, ThatIsNotFreeIsRefusedWithBothNumbers) {
  require_memory(2e10, 2e10, "the mesh", "take a coarser pitch");
  EXPECT_EQ(test::error_of([] { require_memory(3.84e10, 2.05e10, "the mesh", "take a coarser pitch"); }),
            "the mesh needs 38.4 GB, and 20.5 GB are free: take a coarser pitch");
  EXPECT_EQ(in_bytes(7.28e12), "7.3 TB");
  EXPECT_EQ(in_bytes(999), "999 bytes");
}

}  // namespace
}  // namespace riffler::base::memory_test
