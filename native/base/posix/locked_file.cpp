#include "base/locked_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "base/path_text.hpp"

namespace riffler::base {

namespace {

int descriptor(std::intptr_t file) {
  return static_cast<int>(file);
}

}  // namespace

LockedFile::LockedFile(const std::filesystem::path& path) : name_(file_name(path)) {
  file_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file_ < 0) fail("cannot be opened for writing");
  try {
    if (::flock(descriptor(file_), LOCK_EX | LOCK_NB) != 0) fail("is being written by another program");
    struct stat status{};
    if (::fstat(descriptor(file_), &status) != 0) fail("cannot be read");
    if (!S_ISREG(status.st_mode))
      throw std::runtime_error(name_ + ": is a pipe or a device, not a file: take another name");
  } catch (...) {
    ::close(descriptor(file_));
    throw;
  }
}

LockedFile::~LockedFile() {
  ::close(descriptor(file_));
}

std::uint64_t LockedFile::size() const {
  struct stat status{};
  if (::fstat(descriptor(file_), &status) != 0) fail("cannot be read");
  return static_cast<std::uint64_t>(status.st_size);
}

void LockedFile::write_at(std::span<const std::uint8_t> bytes, std::uint64_t at) {
  while (!bytes.empty()) {
    const ssize_t n = ::pwrite(descriptor(file_), bytes.data(), bytes.size(), static_cast<off_t>(at));
    if (n < 0 && errno == EINTR) continue;
    if (n == 0) errno = ENOSPC;  // no system does this, but none rules it out; retrying could loop for ever
    if (n <= 0) fail("cannot be written");
    bytes = bytes.subspan(static_cast<std::size_t>(n));
    at += static_cast<std::uint64_t>(n);
  }
}

bool LockedFile::cut(std::uint64_t size) noexcept {
  return ::ftruncate(descriptor(file_), static_cast<off_t>(size)) == 0;
}

void LockedFile::flush() {
  if (::fdatasync(descriptor(file_)) != 0) fail("cannot be flushed to the disk");
}

void LockedFile::fail(const char* what) const {
  throw std::runtime_error(name_ + ": " + what + ": " + std::strerror(errno));
}

}  // namespace riffler::base
