// Atomic writing of files: a file is complete or absent.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace riffler::base {

/// Writes a new file that replaces `path` when `commit` is called; without a commit it leaves nothing behind. Follows
/// links, even to a file that does not exist yet. An existing file keeps its permissions and, if the system lets this
/// process give files away, its owner and group; a new file gets the usual ones. Refuses everything but regular files
/// (folders, pipes, devices). Every failure throws std::runtime_error with the base name and the system's reason.
///
/// The draft has no name until it is complete, so a killed process leaves nothing behind. On Windows, and on file
/// systems without nameless files, it is called `.NAME.riffler-XXXXXX` and locked; the next writer of the same file
/// removes an abandoned one.
class AtomicFileWriter {
 public:
  explicit AtomicFileWriter(const std::filesystem::path& path);
  AtomicFileWriter(const AtomicFileWriter&) = delete;
  AtomicFileWriter& operator=(const AtomicFileWriter&) = delete;
  ~AtomicFileWriter() { discard(); }

  void write(std::span<const std::uint8_t> bytes);
  void commit();  ///< call once

  /// Descriptor of the draft, open until commit().
  int descriptor() const noexcept { return fd_; }

 private:
  void open_draft();
  void discard() noexcept;

  std::filesystem::path target_;  // links resolved
  std::filesystem::path draft_;   // empty while the draft has no name
  int fd_ = -1;
};

/// The target of `path` with all links followed, if a file can replace it; otherwise throws std::runtime_error as
/// above.
std::filesystem::path replaceable(const std::filesystem::path& path);

/// Replaces `path` with the file `draft` of the same file system, as above.
void replace_file(const std::filesystem::path& draft, const std::filesystem::path& path);

/// Prefix of the names that drafts of `path` have, in the same folder.
std::filesystem::path draft_prefix(const std::filesystem::path& path);

/// Removes drafts of `path` (files and folders) that are not locked; killed processes left them behind.
void clear_drafts(const std::filesystem::path& path) noexcept;

}  // namespace riffler::base
