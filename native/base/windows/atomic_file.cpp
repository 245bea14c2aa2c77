#include "base/atomic_file.hpp"

#include <fcntl.h>
#include <io.h>
#include <windows.h>

#include <cstdint>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "base/draft_names.hpp"
#include "base/path_text.hpp"
#include "base/windows/wide.hpp"

namespace riffler::base {

namespace {

namespace fs = std::filesystem;

constexpr int kRetries = 40;  // times 50 ms: scanners for viruses and indexers open new files for a moment
constexpr DWORD kPause = 50;

[[noreturn]] void fail(const fs::path& path, const std::string& what) {
  throw std::runtime_error(file_name(path) + ": " + what);
}

[[noreturn]] void fail_system(const fs::path& path, const char* what, std::uint32_t error) {
  fail(path, std::string(what) + ": " + error_text(error));
}

/// Whether there is a regular file.
bool is_file(const fs::path& path) {
  const DWORD attributes = GetFileAttributesW(long_path(path).c_str());
  if (attributes == INVALID_FILE_ATTRIBUTES) {
    const DWORD error = GetLastError();
    if (error == ERROR_FILE_NOT_FOUND || error == ERROR_PATH_NOT_FOUND) return false;
    fail_system(path, "cannot be written", error);
  }
  if (attributes & FILE_ATTRIBUTE_DIRECTORY) fail(path, "is a folder, not a file: give the file a name");
  if (attributes & FILE_ATTRIBUTE_DEVICE)
    fail(path, "is a pipe or a device, not a file that can be replaced: take another name");
  return true;
}

bool held_by_another(DWORD error) {
  return error == ERROR_SHARING_VIOLATION || error == ERROR_ACCESS_DENIED || error == ERROR_LOCK_VIOLATION ||
         error == ERROR_UNABLE_TO_REMOVE_REPLACED;
}

/// Puts the draft in the target's place. An existing target passes its rights on. Returns the error of Windows, or 0.
DWORD replace(const std::wstring& draft, const std::wstring& target) {
  constexpr DWORD kFlags = REPLACEFILE_IGNORE_MERGE_ERRORS | REPLACEFILE_IGNORE_ACL_ERRORS;
  if (GetFileAttributesW(target.c_str()) != INVALID_FILE_ATTRIBUTES) {
    if (ReplaceFileW(target.c_str(), draft.c_str(), nullptr, kFlags, nullptr, nullptr)) return 0;
    if (const DWORD error = GetLastError(); held_by_another(error)) return error;
  }
  constexpr DWORD kMove = MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH;
  return MoveFileExW(draft.c_str(), target.c_str(), kMove) ? 0 : GetLastError();
}

void replace_soon(const fs::path& draft, const fs::path& target) {
  const std::wstring from = long_path(draft), to = long_path(target);
  for (int k = 0;; ++k) {
    const DWORD error = replace(from, to);
    if (error == 0) return;
    if (held_by_another(error) && k < kRetries) {
      Sleep(kPause);
      continue;
    }
    const char* const remedy = held_by_another(error) ? "; close the program that uses it, or allow writing it" : "";
    fail(target, "cannot be replaced: " + error_text(error) + remedy);
  }
}

}  // namespace

AtomicFileWriter::AtomicFileWriter(const fs::path& path) : target_(followed(path)) {
  is_file(target_);
  open_draft();
}

/// Others may read the draft, but neither write nor remove it while it is open: this is its lock.
void AtomicFileWriter::open_draft() {
  clear_drafts(target_);
  while (fd_ < 0) {
    draft_ = random_draft(target_);
    const HANDLE file = CreateFileW(long_path(draft_).c_str(), GENERIC_READ | GENERIC_WRITE, FILE_SHARE_READ, nullptr,
                                    CREATE_NEW, FILE_ATTRIBUTE_NORMAL, nullptr);
    if (file == INVALID_HANDLE_VALUE) {
      const DWORD error = GetLastError();
      if (error == ERROR_FILE_EXISTS || error == ERROR_ALREADY_EXISTS) continue;
      draft_.clear();
      fail_system(target_, "cannot be written", error);
    }
    fd_ = _open_osfhandle(reinterpret_cast<std::intptr_t>(file), _O_BINARY | _O_NOINHERIT);
    if (fd_ < 0) {
      CloseHandle(file);
      DeleteFileW(long_path(draft_).c_str());
      draft_.clear();
      fail(target_, "cannot be written: too many files are open");
    }
  }
}

void AtomicFileWriter::discard() noexcept {
  if (fd_ >= 0) _close(std::exchange(fd_, -1));
  if (!draft_.empty()) DeleteFileW(long_path(draft_).c_str());
  draft_.clear();
}

void AtomicFileWriter::write(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kMost = std::size_t{1} << 30;  // the system counts in 32 bits
  const auto file = reinterpret_cast<HANDLE>(_get_osfhandle(fd_));
  while (!bytes.empty()) {
    DWORD n = 0;
    if (!WriteFile(file, bytes.data(), static_cast<DWORD>(std::min(bytes.size(), kMost)), &n, nullptr))
      fail_system(target_, "cannot be written", GetLastError());
    bytes = bytes.subspan(n);
  }
}

void AtomicFileWriter::commit() {
  if (!FlushFileBuffers(reinterpret_cast<HANDLE>(_get_osfhandle(fd_))))
    fail_system(target_, "cannot be written", GetLastError());
  _close(std::exchange(fd_, -1));
  is_file(target_);  // it may have changed in the meantime
  replace_soon(draft_, target_);
  draft_.clear();
}

fs::path replaceable(const fs::path& path) {
  fs::path target = followed(path);
  is_file(target);
  return target;
}

void replace_file(const fs::path& draft, const fs::path& path) {
  const fs::path target = followed(path);
  is_file(target);
  replace_soon(draft, target);
}

void clear_drafts(const fs::path& path) noexcept try {
  const std::wstring begin = draft_prefix(path).filename().native();
  std::error_code error;
  for (fs::directory_iterator at(folder_of(path), error), end; !error && at != end; at.increment(error)) {
    if (!at->path().filename().native().starts_with(begin)) continue;
    std::error_code in_use;
    fs::remove_all(at->path(), in_use);
  }
} catch (...) {  // out of memory: leave the drafts for another time
}

}  // namespace riffler::base
