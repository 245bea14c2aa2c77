// What belongs to the process that made it: threads, what they wait on, and their processor time.
#pragma once

#include <unistd.h>

#include <ctime>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

namespace riffler::base {

/// The process in which it was made. A process that was forked from that one has copies of its objects, but none of
/// its threads: to wait for one there would never end, nor would a lock that one held be freed.
class HomeProcess {
 public:
  bool here() const noexcept { return pid_ == getpid(); }
  /// std::runtime_error in another process; `what` in its message, such as "the session".
  void check(const char* what) const {
    if (!here())
      throw std::runtime_error(std::string(what) +
                               " belongs to the process that this one was forked from: make it anew here");
  }

 private:
  pid_t pid_ = getpid();
};

/// A T that a forked process forgets instead of destroying its copy: the destructor of a condition variable waits for
/// the threads that wait there, that of a thread terminates.
template <class T>
class HomeOnly {
 public:
  template <class... Arguments>
  explicit HomeOnly(Arguments&&... arguments) : value_(std::make_unique<T>(std::forward<Arguments>(arguments)...)) {}
  HomeOnly(HomeOnly&&) noexcept = default;
  HomeOnly& operator=(HomeOnly&& other) noexcept {
    std::swap(value_, other.value_), std::swap(home_, other.home_);
    return *this;
  }
  ~HomeOnly() {
    if (!home_.here()) static_cast<void>(value_.release());
  }

  bool here() const noexcept { return home_.here(); }
  T& operator*() const noexcept { return *value_; }
  T* operator->() const noexcept { return value_.get(); }

 private:
  std::unique_ptr<T> value_;
  HomeProcess home_;
};

/// A thread that is joined by its destructor, if not before; a forked process forgets it.
class OwnThread {
 public:
  OwnThread() = default;
  template <class F>
  explicit OwnThread(F&& f) : thread_(std::forward<F>(f)) {}
  OwnThread(OwnThread&&) noexcept = default;
  OwnThread& operator=(OwnThread&&) noexcept = default;
  ~OwnThread() { join(); }

  void join() noexcept {
    if (thread_.here() && thread_->joinable()) thread_->join();
  }
  bool joinable() const noexcept { return thread_->joinable(); }

 private:
  HomeOnly<std::thread> thread_;
};

/// Processor time of this thread, s: steps are measured by it, so that other work on the machine does not count.
inline double thread_seconds() noexcept {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace riffler::base
