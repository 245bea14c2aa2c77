#include "base/locked_file.hpp"

#include <windows.h>

#include <algorithm>
#include <stdexcept>

#include "base/path_text.hpp"
#include "base/windows/wide.hpp"

namespace riffler::base {

namespace {

// The byte that is locked. Windows keeps others from reading locked bytes, so it lies far behind the end of most files;
// addon/sculpt/pure/journal.py locks the same one.
constexpr DWORD kLockedByte = DWORD{1} << 30;

OVERLAPPED place(std::uint64_t at) {
  OVERLAPPED out{};
  out.Offset = static_cast<DWORD>(at);
  out.OffsetHigh = static_cast<DWORD>(at >> 32);
  return out;
}

}  // namespace

LockedFile::LockedFile(const std::filesystem::path& path) : name_(file_name(path)) {
  constexpr DWORD kShared = FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE;
  const HANDLE file = CreateFileW(long_path(path).c_str(), GENERIC_READ | GENERIC_WRITE, kShared, nullptr, OPEN_ALWAYS,
                                  FILE_ATTRIBUTE_NORMAL, nullptr);
  if (file == INVALID_HANDLE_VALUE) fail("cannot be opened for writing");
  file_ = reinterpret_cast<std::intptr_t>(file);
  try {
    OVERLAPPED at = place(kLockedByte);
    if (GetFileType(file) != FILE_TYPE_DISK)
      throw std::runtime_error(name_ + ": is a pipe or a device, not a file: take another name");
    if (!LockFileEx(file, LOCKFILE_EXCLUSIVE_LOCK | LOCKFILE_FAIL_IMMEDIATELY, 0, 1, 0, &at))
      fail("is being written by another program");
  } catch (...) {
    CloseHandle(file);
    throw;
  }
}

LockedFile::~LockedFile() {
  CloseHandle(reinterpret_cast<HANDLE>(file_));
}

std::uint64_t LockedFile::size() const {
  LARGE_INTEGER size{};
  if (!GetFileSizeEx(reinterpret_cast<HANDLE>(file_), &size)) fail("cannot be read");
  return static_cast<std::uint64_t>(size.QuadPart);
}

void LockedFile::write_at(std::span<const std::uint8_t> bytes, std::uint64_t at) {
  constexpr std::size_t kMost = std::size_t{1} << 30;  // the system counts in 32 bits
  while (!bytes.empty()) {
    OVERLAPPED where = place(at);
    DWORD n = 0;
    const auto size = static_cast<DWORD>(std::min(bytes.size(), kMost));
    if (!WriteFile(reinterpret_cast<HANDLE>(file_), bytes.data(), size, &n, &where)) fail("cannot be written");
    if (n == 0) {
      SetLastError(ERROR_DISK_FULL);  // no system does this, but none rules it out; retrying could loop for ever
      fail("cannot be written");
    }
    bytes = bytes.subspan(n);
    at += n;
  }
}

bool LockedFile::cut(std::uint64_t size) noexcept {
  FILE_END_OF_FILE_INFO end{};
  end.EndOfFile.QuadPart = static_cast<LONGLONG>(size);
  return SetFileInformationByHandle(reinterpret_cast<HANDLE>(file_), FileEndOfFileInfo, &end, sizeof end);
}

void LockedFile::flush() {
  if (!FlushFileBuffers(reinterpret_cast<HANDLE>(file_))) fail("cannot be flushed to the disk");
}

void LockedFile::fail(const char* what) const {
  throw std::runtime_error(name_ + ": " + what + ": " + error_text(GetLastError()));
}

}  // namespace riffler::base
