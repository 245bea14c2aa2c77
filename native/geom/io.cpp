#include "geom/io.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <system_error>
#include <utility>

#include "geom/error.hpp"

namespace riffler {

namespace fs = std::filesystem;

std::vector<std::uint8_t> read_file(const fs::path& path) {
  const std::string name = path.filename().string();
  std::error_code code;
  if (fs::is_directory(path, code)) throw FormatError(name, "", "is a directory, not a file");
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  if (!in) throw FormatError(name, "", std::string("cannot be opened: ") + std::strerror(errno));
  const std::streamoff size = in.tellg();
  std::vector<std::uint8_t> bytes(size > 0 ? static_cast<std::size_t>(size) : 0);
  in.seekg(0);
  if (!bytes.empty() && !in.read(reinterpret_cast<char*>(bytes.data()), size))
    throw FormatError(name, "byte " + std::to_string(in.gcount()), "cannot be read further");
  return bytes;
}

namespace {

[[noreturn]] void fail(const fs::path& path, const char* what) {
  throw std::runtime_error(path.filename().string() + ": " + what + ": " + std::strerror(errno));
}

}  // namespace

NewFile::NewFile(const fs::path& path) : path_(path), name_(path.string() + ".XXXXXX") {
  fd_ = mkstemp(name_.data());
  if (fd_ < 0) fail(path_, "cannot be written");
}

NewFile::~NewFile() {
  if (fd_ >= 0) close(fd_);
  if (!done_) unlink(name_.c_str());
}

void NewFile::write(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd_, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail(path_, "cannot be written");
    bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
#ifdef __linux__
  sync_file_range(fd_, 0, 0, SYNC_FILE_RANGE_WRITE);  // begin now what `commit` waits for; a hint, which may be refused
#endif
}

void NewFile::commit() {
  const mode_t mask = umask(0);
  umask(mask);
  // mkstemp makes a private file; the result has the mode that an ordinary new file would have.
  if (fchmod(fd_, 0666 & ~mask) != 0 || fsync(fd_) != 0) fail(path_, "cannot be written");
  const int fd = std::exchange(fd_, -1);
  if (close(fd) != 0) fail(path_, "cannot be written");
  if (std::rename(name_.c_str(), path_.c_str()) != 0) fail(path_, "cannot be replaced");
  done_ = true;
}

void write_file(const fs::path& path, std::span<const std::uint8_t> bytes) {
  NewFile file(path);
  file.write(bytes);
  file.commit();
}

void write_file(const fs::path& path, std::string_view text) {
  write_file(path, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

}  // namespace riffler
