// Memory for blocks that come and go all the time, kept ready for the next: a step of the pen does not wait for the
// system, nor for a thread that does.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace riffler::base {

/// A block of at least that many bytes, from those that were freed or from the system; any thread may free it. Nobody
/// waits for another thread. Throws std::bad_alloc.
void* allocate_block(std::size_t bytes);
void free_block(void* memory, std::size_t bytes) noexcept;

/// As long as one lives, up to 32 MB of freed blocks are kept, otherwise 2 MB.
class BlockReserve {
 public:
  BlockReserve() noexcept;
  BlockReserve(const BlockReserve&) = delete;
  BlockReserve& operator=(const BlockReserve&) = delete;
  ~BlockReserve();

  /// Sees to it that so many blocks of every size up to `largest` bytes are ready and no others, as far as the 32 MB
  /// allow, small ones first: for a thread that has time, so that another need not ask the system. Throws
  /// std::bad_alloc.
  void fill(std::size_t largest, std::size_t count);
};

/// How often blocks had to come from the system so far, in this thread.
std::uint64_t blocks_from_system();

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

template <class T>
using BlockVector = std::vector<T, BlockAllocator<T>>;

template <class T, class... Arguments>
std::shared_ptr<T> make_shared_block(Arguments&&... arguments) {
  return std::allocate_shared<T>(BlockAllocator<T>(), std::forward<Arguments>(arguments)...);
}

}  // namespace riffler::base
