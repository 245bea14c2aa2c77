// One call at a time on an object whose calls release the GIL.
#pragma once

#include <mutex>
#include <stdexcept>
#include <string>

namespace riffler::bindings {

/// What an object inherits whose calls change it without Python's lock.
struct Guarded {
  std::mutex mutex;
};

/// Held through such a call: another thread that comes meanwhile gets a clear error. It does not wait, which it would
/// with the lock that the first thread's progress callback needs.
class OneCaller {
 public:
  /// `what` in messages, such as "the mesher".
  OneCaller(Guarded& object, const char* what) : held_(object.mutex, std::try_to_lock) {
    if (!held_) throw std::runtime_error(std::string(what) + " is in use by another thread");
  }

 private:
  std::unique_lock<std::mutex> held_;
};

}  // namespace riffler::bindings
