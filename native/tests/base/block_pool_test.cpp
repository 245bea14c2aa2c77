#include "riffler/base/block_pool.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <thread>
#include <vector>

#include "stress/random.hpp"

namespace riffler::base::block_pool_test {
namespace {

TEST(BlockPool, ReusesFreedBlocksAndCountsThoseOfTheSystem) {
  void* first = allocate_block(9999);
  free_block(first, 9999);
  const std::uint64_t before = blocks_from_system();
  for (const std::size_t bytes : {9999, 9990, 10'240}) {  // of one class
    void* block = allocate_block(bytes);
    std::memset(block, 1, bytes);
    free_block(block, bytes);
  }
  EXPECT_EQ(blocks_from_system(), before);
}

TEST(BlockPool, BlocksOfAnySizeDoNotOverlap) {
  struct Block {
    unsigned char* at;
    std::size_t bytes;
    unsigned char mark;
  };
  stress::Random random(12);
  std::vector<Block> held;
  for (int k = 0; k < 20'000; ++k) {
    if (held.size() < 200 && random.uniform() < 0.55) {
      const auto bytes = static_cast<std::size_t>(std::exp2(random.uniform(0, 18)));
      const auto mark = static_cast<unsigned char>(k);
      held.push_back({static_cast<unsigned char*>(allocate_block(bytes)), bytes, mark});
      std::memset(held.back().at, mark, bytes);
    } else if (!held.empty()) {
      std::swap(held[static_cast<std::size_t>(random.below(static_cast<int>(held.size())))], held.back());
      const Block b = held.back();
      ASSERT_TRUE(std::all_of(b.at, b.at + b.bytes, [&](unsigned char byte) { return byte == b.mark; }));
      free_block(b.at, b.bytes), held.pop_back();
    }
  }
  for (const Block& b : held) free_block(b.at, b.bytes);
}

TEST(BlockPool, BlocksGoFromThreadToThread) {
  std::vector<std::thread> threads;
  std::vector<BlockVector<int>> made[4];
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&, t] {
      for (int round = 0; round < 200; ++round) {
        made[t].clear();
        for (int k = 0; k < 20; ++k) made[t].emplace_back(static_cast<std::size_t>(100 + 37 * k), t);
        for (const auto& v : made[t])
          for (const int x : v) ASSERT_EQ(x, t);
      }
    });
  for (auto& thread : threads) thread.join();
  // Freed by another thread than the one that asked.
  for (auto& some : made) some.clear();
}

/// Bytes of some sizes that need not come from the system.
std::size_t ready() {
  std::size_t sum = 0;
  for (const std::size_t bytes : {64U, 1U << 12, 1U << 14, 1U << 17}) {
    const std::uint64_t before = blocks_from_system();
    std::vector<void*> blocks;
    while (blocks_from_system() == before && blocks.size() < 1000) blocks.push_back(allocate_block(bytes));
    EXPECT_LE(blocks.size(), 257U);
    sum += (blocks.size() - 1) * bytes;
    for (void* block : blocks) free_block(block, bytes);
  }
  return sum;
}

TEST(BlockPool, KeepsNoMoreFreeBlocksThanItsShare) {
  {
    BlockReserve reserve;
    reserve.fill(1 << 17, 100'000);  // of all sizes: would be 60 GB
    EXPECT_GT(ready(), 1U << 20);
    EXPECT_LE(ready(), 32U << 20);
    reserve.fill(1 << 14, 100);
    EXPECT_EQ(ready(), 100U * (64 + (1 << 12) + (1 << 14)));
  }
  EXPECT_LE(ready(), 2U << 20) << "without a reserve";
}

/// Otherwise what a program freed long ago decides whether a step of the pen asks the system.
TEST(BlockPool, UnusedFreeBlocksMakeRoomForOthers) {
  {
    const BlockReserve empties;
  }
  std::vector<std::pair<void*, std::size_t>> old;
  for (std::size_t bytes = 1 << 16; bytes >= 32; bytes /= 2)
    for (int k = 0; k < 60; ++k) old.emplace_back(allocate_block(bytes), bytes);
  for (const auto& [memory, bytes] : old) free_block(memory, bytes);
  for (const std::size_t bytes : {100U, 5000U, 1U << 17}) {
    const auto turns = [bytes](int count) {
      for (int k = 0; k < count; ++k) free_block(allocate_block(bytes), bytes);
    };
    turns(20);
    const std::uint64_t before = blocks_from_system();
    turns(100);
    EXPECT_EQ(blocks_from_system(), before) << bytes;
  }
  EXPECT_LE(ready(), 2U << 20);
}

}  // namespace
}  // namespace riffler::base::block_pool_test
