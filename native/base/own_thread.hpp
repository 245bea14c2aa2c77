// Objects that belong to the process that made them: threads, what threads wait on, and processor time.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

namespace riffler::base {

/// The system's number of this process.
int process_number() noexcept;

/// Remembers the process that made it. A forked process has copies of its parent's objects but none of its threads:
/// waiting for such a thread would never end, and a lock that it held would never be released.
class HomeProcess {
 public:
  bool here() const noexcept { return pid_ == process_number(); }
  /// Throws std::runtime_error in another process. `what` names the object in the message, such as "the session".
  void check(const char* what) const {
    if (!here())
      throw std::runtime_error(std::string(what) +
                               " belongs to the process that this one was forked from: create a new one here");
  }

 private:
  int pid_ = process_number();
};

/// A T whose copy in a forked process is not destroyed: the destructor of a condition variable would wait for its
/// waiting threads, that of a thread would terminate the process.
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
  /// False after a move from it; it may then only be destroyed or assigned to.
  explicit operator bool() const noexcept { return value_ != nullptr; }
  T& operator*() const noexcept { return *value_; }
  T* operator->() const noexcept { return value_.get(); }

 private:
  std::unique_ptr<T> value_;
  HomeProcess home_;
};

/// A thread that its destructor joins, if it has not been joined before. A forked process does not join it.
class OwnThread {
 public:
  OwnThread() = default;
  template <class F>
  explicit OwnThread(F&& f) : thread_(std::forward<F>(f)) {}
  OwnThread(OwnThread&&) noexcept = default;
  OwnThread& operator=(OwnThread&&) noexcept = default;
  ~OwnThread() { join(); }

  void join() noexcept {
    if (thread_.here() && joinable()) thread_->join();
  }
  bool joinable() const noexcept { return thread_ && thread_->joinable(); }

 private:
  HomeOnly<std::thread> thread_;
};

/// Processor time of this thread, s. Steps are measured with it, so that other load on the machine does not count.
double thread_seconds() noexcept;

}  // namespace riffler::base
