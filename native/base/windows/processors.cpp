#include "base/processors.hpp"

#include <windows.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <thread>

namespace riffler::base {

int usable_processors() {
  DWORD_PTR process = 0, system = 0;
  // Both masks are 0 where the process runs on several groups of 64 processors.
  if (GetProcessAffinityMask(GetCurrentProcess(), &process, &system) && process != 0)
    return std::popcount(static_cast<std::uint64_t>(process));
  return static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

}  // namespace riffler::base
