#include "riffler/base/bulk.hpp"

#include <sys/mman.h>

#include <cstdlib>

namespace riffler::base {

namespace {
constexpr std::size_t kHugePage = std::size_t{2} << 20;
}

void* allocate_bulk(std::size_t bytes) {
  const bool huge = bytes >= 2 * kHugePage;
  const std::size_t alignment = huge ? kHugePage : 64, size = (bytes + alignment - 1) / alignment * alignment;
  void* const memory = std::aligned_alloc(alignment, size);
  if (!memory) throw std::bad_alloc();
  if (huge) madvise(memory, size, MADV_HUGEPAGE);  // a hint; the system may ignore it
  return memory;
}

void free_bulk(void* memory) noexcept {
  std::free(memory);
}

}  // namespace riffler::base
