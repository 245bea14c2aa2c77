// Vectors of many megabytes without the cost of zero-filling.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace riffler::base {

/// Allocates memory for bulk data, in huge pages where the system has them: a first touch of a 4 kB page costs more
/// than filling it.
void* allocate_bulk(std::size_t bytes);
/// Frees memory from allocate_bulk.
void free_bulk(void* memory) noexcept;

/// Leaves elements that `resize` adds uninitialised: the caller writes them next, often from several threads.
template <class T>
struct BulkAllocator {
  using value_type = T;
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

  BulkAllocator() = default;
  template <class U>
  BulkAllocator(const BulkAllocator<U>&) {}

  T* allocate(std::size_t n) { return static_cast<T*>(allocate_bulk(n * sizeof(T))); }
  void deallocate(T* memory, std::size_t) noexcept { free_bulk(memory); }
  template <class U>
  void construct(U* place) noexcept {
    ::new (static_cast<void*>(place)) U;
  }
  template <class U, class... Arguments>
  void construct(U* place, Arguments&&... arguments) {
    ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
  }
  friend bool operator==(const BulkAllocator&, const BulkAllocator&) { return true; }
};

/// Vector whose new elements are uninitialised after `resize`.
template <class T>
using BulkVector = std::vector<T, BulkAllocator<T>>;

}  // namespace riffler::base
