// Brings an object into the cache before it is read, so that its reader need not wait for memory.
#pragma once

#include <cstddef>

namespace riffler::base {

template <class T>
inline void fetch(const T& object) {
  constexpr std::size_t kLine = 64;  // bytes of a cache line
  const char* first = reinterpret_cast<const char*>(&object);
  for (std::size_t i = 0; i < sizeof(T); i += kLine) __builtin_prefetch(first + i);
}

}  // namespace riffler::base
