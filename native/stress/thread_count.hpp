// Sets the number of threads within a scope.
#pragma once

#include <cstdlib>
#include <string>

namespace riffler::stress {

/// Sets RIFFLER_THREADS during its lifetime.
class ThreadCount {
 public:
  explicit ThreadCount(const char* count) {
    if (const char* text = std::getenv("RIFFLER_THREADS")) before_ = text;
    setenv("RIFFLER_THREADS", count, 1);
  }
  ThreadCount(const ThreadCount&) = delete;
  ThreadCount& operator=(const ThreadCount&) = delete;
  ~ThreadCount() {
    if (before_.empty())
      unsetenv("RIFFLER_THREADS");
    else
      setenv("RIFFLER_THREADS", before_.c_str(), 1);
  }

 private:
  std::string before_;
};

}  // namespace riffler::stress
