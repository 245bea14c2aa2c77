#include "riffler/base/bulk.hpp"

#include <malloc.h>

namespace riffler::base {

void* allocate_bulk(std::size_t bytes) {
  constexpr std::size_t kAlignment = 64;
  void* const memory = _aligned_malloc(bytes > 0 ? bytes : kAlignment, kAlignment);
  if (!memory) throw std::bad_alloc();
  return memory;
}

void free_bulk(void* memory) noexcept {
  _aligned_free(memory);
}

}  // namespace riffler::base
