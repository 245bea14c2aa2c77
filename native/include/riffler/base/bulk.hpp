// Vectors of many megabytes that a call fills itself.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace riffler::base {

/// Memory for bulk data, in huge pages where the system gives them: a fresh page of 4 kB costs more than the writing.
void* allocate_bulk(std::size_t bytes);
void free_bulk(void* memory) noexcept;

/// Leaves elements that `resize` adds as they are: they are about to be written, by several threads at once.
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

template <class T>
using BulkVector = std::vector<T, BulkAllocator<T>>;

}  // namespace riffler::base
