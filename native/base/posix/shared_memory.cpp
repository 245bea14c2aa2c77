#include "base/shared_memory.hpp"

#include <linux/futex.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <climits>
#include <cmath>
#include <ctime>
#include <system_error>

namespace riffler::base {
namespace {

[[noreturn]] void fail(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

/// Calls a futex that processes share; that of std::atomic::wait is private to one process.
long shared_futex(const std::atomic<std::uint32_t>& word, int operation, std::uint32_t value, const timespec* limit) {
  static_assert(sizeof word == 4 && std::atomic<std::uint32_t>::is_always_lock_free);
  return ::syscall(SYS_futex, reinterpret_cast<const std::uint32_t*>(&word), operation, value, limit, nullptr, 0);
}

}  // namespace

SharedMemory::SharedMemory(std::size_t bytes) : file_(::memfd_create("riffler", MFD_CLOEXEC)), bytes_(bytes) {
  if (file_ < 0) fail("shared memory");
  if (::ftruncate(file_, static_cast<off_t>(bytes)) != 0) {
    const int error = errno;
    ::close(file_);
    errno = error;
    fail("shared memory");
  }
  map();
}

SharedMemory::SharedMemory(int file, std::size_t bytes) : file_(file), bytes_(bytes) {
  struct stat status{};
  if (::fstat(file, &status) != 0) fail("shared memory");
  if (static_cast<std::size_t>(status.st_size) != bytes)
    throw std::system_error(EINVAL, std::generic_category(), "shared memory of another size");
  map();
}

void SharedMemory::map() {
  data_ = ::mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_SHARED, file_, 0);
  if (data_ != MAP_FAILED) return;
  const int error = errno;
  ::close(file_);
  errno = error;
  fail("shared memory");
}

SharedMemory::~SharedMemory() {
  ::munmap(data_, bytes_);
  ::close(file_);
}

void wait_for_change(const std::atomic<std::uint32_t>& word, std::uint32_t seen, double seconds) noexcept {
  if (!(seconds > 0) || word.load(std::memory_order_acquire) != seen) return;
  const double whole = std::floor(std::fmin(seconds, 1e6));
  const timespec limit{static_cast<time_t>(whole), static_cast<long>(1e9 * std::fmin(seconds - whole, 0.999999999))};
  shared_futex(word, FUTEX_WAIT, seen, &limit);
}

void change(std::atomic<std::uint32_t>& word) noexcept {
  word.fetch_add(1, std::memory_order_release);
  shared_futex(word, FUTEX_WAKE, INT_MAX, nullptr);
}

}  // namespace riffler::base
