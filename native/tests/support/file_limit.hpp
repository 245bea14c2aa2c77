// A disk that is full, for the files of this process.
#pragma once

#include <sys/resource.h>

#include <csignal>
#include <cstdint>

namespace riffler::test {

/// No file grows beyond `bytes` as long as this lives: what is beyond is a short write, then EFBIG.
class FileLimit {
 public:
  explicit FileLimit(std::uint64_t bytes) : signal_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    rlimit limit = before_;
    limit.rlim_cur = bytes;
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  FileLimit(const FileLimit&) = delete;
  FileLimit& operator=(const FileLimit&) = delete;
  ~FileLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, signal_);
  }

 private:
  void (*signal_)(int);
  rlimit before_{};
};

}  // namespace riffler::test
