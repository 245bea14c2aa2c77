#include "base/freed_memory.hpp"

#include <cstdlib>
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace riffler::base {

void reuse_freed_memory() noexcept {
#ifdef __GLIBC__
  // The limits to which glibc would adapt at most (man 3 mallopt).
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, 64 << 20);
#endif
}

}  // namespace riffler::base
