#include "base/shared_memory.hpp"

#include <windows.h>

#include <algorithm>
#include <cmath>
#include <system_error>

#include "base/windows/wide.hpp"

namespace riffler::base {

namespace {

[[noreturn]] void fail() {
  throw std::system_error(static_cast<int>(last_error()), std::system_category(), "shared memory");
}

}  // namespace

/// As no program can be started that it could be shared with (child_process.hpp), this is memory of this process.
SharedMemory::SharedMemory(std::size_t bytes) : file_(-1), bytes_(bytes) {
  map();
}

SharedMemory::SharedMemory(int, std::size_t) {
  throw std::system_error(std::make_error_code(std::errc::function_not_supported), "shared memory");
}

void SharedMemory::map() {
  data_ = VirtualAlloc(nullptr, bytes_, MEM_RESERVE | MEM_COMMIT, PAGE_READWRITE);
  if (!data_) fail();
}

SharedMemory::~SharedMemory() {
  VirtualFree(data_, 0, MEM_RELEASE);
}

void wait_for_change(const std::atomic<std::uint32_t>& word, std::uint32_t seen, double seconds) noexcept {
  if (!(seconds > 0) || word.load(std::memory_order_acquire) != seen) return;
  const auto milliseconds = static_cast<DWORD>(std::ceil(1e3 * std::min(seconds, 1e6)));
  WaitOnAddress(const_cast<std::atomic<std::uint32_t>*>(&word), &seen, sizeof seen, milliseconds);
}

void change(std::atomic<std::uint32_t>& word) noexcept {
  word.fetch_add(1, std::memory_order_release);
  WakeByAddressAll(&word);
}

}  // namespace riffler::base
