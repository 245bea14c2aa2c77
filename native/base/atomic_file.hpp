// Files that are whole or not there.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace riffler::base {

/// Writes a file that takes the place of `path` when `commit` is called, and leaves nothing where it is not. A link is
/// followed, to a file that is not there yet as well; a file that is there keeps its permissions, and its owner and
/// group as far as the system lets this process give a file away; a new one gets those of any new file. What is no
/// regular file (a folder, a pipe, a device) is refused. std::runtime_error with the base name and the system's reason
/// wherever it cannot be.
///
/// The draft has no name until it is whole, so that nothing is left of a process that is killed. On file systems
/// without such files it is called `.NAME.riffler-XXXXXX`, is locked, and goes with the next that is written if it was
/// left.
class AtomicFileWriter {
 public:
  explicit AtomicFileWriter(const std::filesystem::path& path);
  AtomicFileWriter(const AtomicFileWriter&) = delete;
  AtomicFileWriter& operator=(const AtomicFileWriter&) = delete;
  ~AtomicFileWriter() { discard(); }

  void write(std::span<const std::uint8_t> bytes);
  void commit();  ///< once

  /// Of the draft; open until commit().
  int descriptor() const noexcept { return fd_; }

 private:
  void open_draft();
  void discard() noexcept;

  std::filesystem::path target_;  // links followed
  std::string draft_;             // empty while it has no name
  int fd_ = -1;
};

/// Where `path` leads, links followed, if a file can take its place there; otherwise std::runtime_error as above.
std::filesystem::path replaceable(const std::filesystem::path& path);

/// The file `draft`, on the same file system, takes the place of `path` as above.
void replace_file(const std::filesystem::path& draft, const std::filesystem::path& path);

/// What the name of a draft of `path` begins with, in the same folder.
std::filesystem::path draft_prefix(const std::filesystem::path& path);

/// Removes drafts of `path`, files and folders, that nobody has locked: processes that were killed left them.
void clear_drafts(const std::filesystem::path& path) noexcept;

}  // namespace riffler::base
