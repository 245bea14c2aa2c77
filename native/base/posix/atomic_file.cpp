#include "base/atomic_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "base/draft_names.hpp"
#include "base/path_text.hpp"

namespace riffler::base {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& what) {
  throw std::runtime_error(file_name(path) + ": " + what);
}

[[noreturn]] void fail_system(const fs::path& path, const char* what) {
  fail(path, std::string(what) + ": " + std::strerror(errno));
}

/// Status of an existing regular file; nothing if there is no file.
std::optional<struct stat> status_of(const fs::path& path) {
  struct stat status{};
  if (::stat(path.c_str(), &status) != 0) {
    if (errno == ENOENT) return {};
    fail_system(path, "cannot be written");
  }
  if (S_ISDIR(status.st_mode)) fail(path, "is a folder, not a file: give the file a name");
  if (!S_ISREG(status.st_mode)) fail(path, "is a pipe or a device, not a file that can be replaced: take another name");
  return status;
}

/// Gives the new file the permissions and the owner of the old one.
void take_over(int fd, const struct stat& old, const fs::path& path) {
  struct stat mine{};
  if (fstat(fd, &mine) != 0) fail_system(path, "cannot be written");
  mode_t mode = old.st_mode & 0777;
  if (mine.st_uid != old.st_uid || mine.st_gid != old.st_gid) {
    // Only root can give a file away; a group that the process belongs to can be kept.
    if (fchown(fd, old.st_uid, old.st_gid) != 0 && fchown(fd, static_cast<uid_t>(-1), old.st_gid) != 0)
      mode &= ~mode_t{070} | (mode & 07) << 3;  // a different group gets no more rights than everybody
  }
  if (fchmod(fd, mode) != 0) fail_system(path, "its permissions cannot be kept");
}

bool locked(int fd) {
  return flock(fd, LOCK_EX | LOCK_NB) == 0;
}

/// Gives the nameless file a new name next to its target.
std::string linked(int fd, const fs::path& target) {
  const std::string open_file = "/proc/self/fd/" + std::to_string(fd);
  while (true) {
    std::string name = random_draft(target).native();
    if (linkat(AT_FDCWD, open_file.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0) return name;
    if (errno != EEXIST) fail_system(target, "cannot be written");
  }
}

}  // namespace

AtomicFileWriter::AtomicFileWriter(const fs::path& path) : target_(followed(path)) {
  const std::optional<struct stat> old = status_of(target_);
  open_draft();
  try {
    if (old) take_over(fd_, *old, target_);
  } catch (...) {
    discard();
    throw;
  }
}

void AtomicFileWriter::open_draft() {
#ifdef O_TMPFILE
  // Through its name in /proc, the file can be linked into the folder later.
  if (access("/proc/self/fd", X_OK) == 0) fd_ = open(folder_of(target_).c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
#endif
  if (fd_ >= 0) {
    locked(fd_);
    return;
  }
  clear_drafts(target_);
  while (fd_ < 0) {
    draft_ = random_draft(target_).native();
    fd_ = open(draft_.c_str(), O_CREAT | O_EXCL | O_NOFOLLOW | O_RDWR | O_CLOEXEC, 0666);
    if (fd_ < 0 && errno == EEXIST) continue;
    if (fd_ < 0) {
      draft_.clear();
      fail_system(target_, "cannot be written");
    }
    struct stat status{};
    locked(fd_);
    // Another writer may have removed the draft before it was locked.
    if (fstat(fd_, &status) == 0 && status.st_nlink == 0) close(std::exchange(fd_, -1));
  }
}

void AtomicFileWriter::discard() noexcept {
  if (!draft_.empty()) unlink(draft_.c_str());
  if (fd_ >= 0) close(std::exchange(fd_, -1));
  draft_.clear();
}

void AtomicFileWriter::write(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd_, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail_system(target_, "cannot be written");
    bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
#ifdef __linux__
  sync_file_range(fd_, 0, 0, SYNC_FILE_RANGE_WRITE);  // hint: start now the writing that `commit` waits for
#endif
}

void AtomicFileWriter::commit() {
  if (fsync(fd_) != 0) fail_system(target_, "cannot be written");
  if (draft_.empty()) draft_ = linked(fd_, target_);
  status_of(target_);  // it may have changed in the meantime
  if (std::rename(draft_.c_str(), target_.c_str()) != 0) fail_system(target_, "cannot be replaced");
  draft_.clear();
  if (close(std::exchange(fd_, -1)) != 0) fail_system(target_, "cannot be written");
}

fs::path replaceable(const fs::path& path) {
  fs::path target = followed(path);
  status_of(target);
  return target;
}

void replace_file(const fs::path& draft, const fs::path& path) {
  const fs::path target = followed(path);
  const std::optional<struct stat> old = status_of(target);
  if (old) {
    const int fd = open(draft.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
    if (fd < 0) fail_system(path, "cannot be written");
    try {
      take_over(fd, *old, target);
    } catch (...) {
      close(fd);
      throw;
    }
    close(fd);
  }
  if (std::rename(draft.c_str(), target.c_str()) != 0) fail_system(target, "cannot be replaced");
}

void clear_drafts(const fs::path& path) noexcept try {
  const std::string begin = file_name(draft_prefix(path));
  std::error_code error;
  for (fs::directory_iterator at(folder_of(path), error), end; !error && at != end; at.increment(error)) {
    if (!file_name(at->path()).starts_with(begin)) continue;
    const int fd = open(at->path().c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (fd < 0) continue;
    if (locked(fd)) {
      std::error_code ignored;
      fs::remove_all(at->path(), ignored);
    }
    close(fd);
  }
} catch (...) {  // out of memory: leave the drafts for another time
}

}  // namespace riffler::base
