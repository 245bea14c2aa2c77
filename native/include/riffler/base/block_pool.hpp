// A pool of freed memory blocks for reuse. A step of the pen has a deadline: it must wait neither for the system's
// allocator nor for another thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace riffler::base {

/// Returns a block of at least `bytes` bytes, from the pool or else from the system. Any thread may free it. Takes no
/// lock, so it never waits for another thread. Throws std::bad_alloc.
void* allocate_block(std::size_t bytes);
/// Returns a block to the pool or the system. `bytes` is the size given to allocate_block. A full pool gives up blocks
/// of other sizes for it.
void free_block(void* memory, std::size_t bytes) noexcept;

/// While any BlockReserve exists, the pool keeps up to 32 MB of freed blocks; otherwise up to 2 MB.
class BlockReserve {
 public:
  BlockReserve() noexcept;
  BlockReserve(const BlockReserve&) = delete;
  BlockReserve& operator=(const BlockReserve&) = delete;
  ~BlockReserve();

  /// Fills the pool with `count` blocks of every block size up to `largest` bytes and returns all other blocks to the
  /// system. Small sizes come first; the total stays within 32 MB. Call it on a thread without a deadline, so that the
  /// thread with one need not ask the system. Throws std::bad_alloc.
  void fill(std::size_t largest, std::size_t count);
};

/// Number of blocks that this thread has had to take from the system so far.
std::uint64_t blocks_from_system();

/// Standard allocator on top of the pool.
template <class T>
struct BlockAllocator {
  using value_type = T;

  BlockAllocator() = default;
  template <class U>
  BlockAllocator(const BlockAllocator<U>&) {}

  T* allocate(std::size_t n) { return static_cast<T*>(allocate_block(n * sizeof(T))); }
  void deallocate(T* memory, std::size_t n) noexcept { free_block(memory, n * sizeof(T)); }
  friend bool operator==(const BlockAllocator&, const BlockAllocator&) { return true; }
};

/// Vector whose storage comes from the pool.
template <class T>
using BlockVector = std::vector<T, BlockAllocator<T>>;

/// std::make_shared whose storage comes from the pool.
template <class T, class... Arguments>
std::shared_ptr<T> make_shared_block(Arguments&&... arguments) {
  return std::allocate_shared<T>(BlockAllocator<T>(), std::forward<Arguments>(arguments)...);
}

}  // namespace riffler::base
