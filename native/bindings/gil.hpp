// Python's lock, released and taken again, so that threads survive the interpreter's end.
#pragma once

#include <Python.h>

namespace riffler::bindings {

/// Releases Python's lock for its life. While Python ends, a daemon thread never gets the lock again: Python
/// before 3.14 ends such a thread by unwinding it, which no destructor survives. Here it waits for the end of the
/// process instead, as it does in Python 3.14 (take_gil.h).
class NoGil {
 public:
  NoGil() : state_(PyEval_SaveThread()) {}
  NoGil(const NoGil&) = delete;
  NoGil& operator=(const NoGil&) = delete;
  ~NoGil();

 private:
  PyThreadState* state_;
};

/// Takes Python's lock for its life, in any thread; see NoGil.
class WithGil {
 public:
  WithGil();
  WithGil(const WithGil&) = delete;
  WithGil& operator=(const WithGil&) = delete;
  ~WithGil() { PyGILState_Release(state_); }

 private:
  PyGILState_STATE state_;
};

}  // namespace riffler::bindings
