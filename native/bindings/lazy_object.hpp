// A property that is made when it is first asked for.
#pragma once

#include <chrono>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "bindings/bindings.hpp"

namespace riffler::bindings {

/// Made once, by one thread; others wait for it without Python's lock, which its maker may need, and Ctrl-C ends the
/// waiting. After an error the next caller tries again.
class LazyObject {
 public:
  /// What `make` returned, the same object each time. Called with the GIL.
  template <class Make>
  py::object get(const Make& make) {
    if (made_) return made_;
    const std::unique_lock held = lock();
    const Maker maker(*this);
    if (!made_) made_ = make();
    return made_;
  }

 private:
  struct Maker {
    explicit Maker(LazyObject& o) : object(o) { object.maker_ = std::this_thread::get_id(); }
    Maker(const Maker&) = delete;
    Maker& operator=(const Maker&) = delete;
    ~Maker() { object.maker_ = {}; }
    LazyObject& object;
  };

  std::unique_lock<std::timed_mutex> lock() {
    // A signal's handler, called while this thread makes it.
    if (maker_ == std::this_thread::get_id()) throw std::runtime_error("it is being made: ask again later");
    std::unique_lock held(making_, std::try_to_lock);
    while (!held) {
      {
        const NoGil release;
        if (held.try_lock_for(std::chrono::milliseconds(30))) break;
      }
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    }
    return held;
  }

  std::timed_mutex making_;
  std::thread::id maker_;  // under the GIL
  py::object made_;
};

}  // namespace riffler::bindings
