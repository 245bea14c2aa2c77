// A file that one writer has open and locked, and that grows record by record.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace riffler::base {

/// Open for reading and writing from construction to destruction, and locked against every other LockedFile of it, in
/// this program and in others. Each failure throws std::runtime_error with the base name and the system's reason.
class LockedFile {
 public:
  /// Creates the file if there is none. Throws where another writer has it, and for a pipe or a device.
  explicit LockedFile(const std::filesystem::path& path);
  LockedFile(const LockedFile&) = delete;
  LockedFile& operator=(const LockedFile&) = delete;
  ~LockedFile();

  /// bytes
  std::uint64_t size() const;
  /// Passes the bytes to the system, from byte `at` of the file. After a failure some of them may be in the file.
  void write_at(std::span<const std::uint8_t> bytes, std::uint64_t at);
  /// Removes all from byte `size` on. False if the system refuses it; fail() then throws its reason.
  bool cut(std::uint64_t size) noexcept;
  /// Flushes the content to the disk. Another thread may write meanwhile.
  void flush();
  /// Throws `what` with the system's reason for the failure of the last call.
  [[noreturn]] void fail(const char* what) const;

 private:
  std::string name_;
  std::intptr_t file_ = -1;  // descriptor, on Windows the handle
};

}  // namespace riffler::base
