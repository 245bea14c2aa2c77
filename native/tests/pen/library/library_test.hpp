// What the tests of makers' libraries share: a stub whose state the test and the program riffler-arm have in common,
// and a pen that is pushed until something happens.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <functional>
#include <new>
#include <string>
#include <thread>

#include "riffler/pen/device.hpp"
#include "riffler/pen/hid/open_error.hpp"
#include "support/stub_libraries.hpp"

namespace riffler::test {

/// The state of a stub, in a file that the environment variable names to the stub.
template <class State>
class StubState {
 public:
  StubState() : file_(::testing::TempDir() + "riffler_stub_XXXXXX") {
    const int file = ::mkstemp(file_.data());
    if (file < 0 || ::ftruncate(file, sizeof(State)) != 0) std::abort();
    state_ = new (::mmap(nullptr, sizeof(State), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0)) State;
    ::close(file);
    ::setenv(State::kVariable, file_.c_str(), 1);
    ::setenv("RIFFLER_ARM_PROGRAM", arm_program_path(), 1);
  }
  ~StubState() {
    ::munmap(state_, sizeof(State));
    ::unlink(file_.c_str());
    ::unsetenv(State::kVariable);
    ::unsetenv("RIFFLER_ARM_PROGRAM");
  }
  StubState(const StubState&) = delete;
  StubState& operator=(const StubState&) = delete;
  State& operator*() const { return *state_; }
  State* operator->() const { return state_; }

 private:
  std::string file_;
  State* state_;
};

/// Pushes until `done`, or for ten seconds; then whether it is. `answer`: of the last push.
inline bool push_until(pen::Pen& pen, const std::function<bool()>& done, const Wrench& wrench,
                       pen::PushAnswer& answer) {
  using namespace std::chrono_literals;
  for (const auto end = std::chrono::steady_clock::now() + 10s; std::chrono::steady_clock::now() < end;) {
    answer = pen.push(wrench);
    if (done()) return true;
    std::this_thread::sleep_for(1ms);
  }
  return done();
}

/// The problem of an OpenError and its text, or "none".
inline std::string open_problem(const std::function<void()>& call) {
  try {
    call();
  } catch (const pen::OpenError& error) {
    return std::string(problem_text(error.problem())) + ": " + error.what();
  }
  return "none";
}

}  // namespace riffler::test
