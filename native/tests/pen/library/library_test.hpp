// What the tests of makers' libraries share: a pen that is pushed until something happens.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <string>
#include <thread>

#include "riffler/pen/device.hpp"
#include "riffler/pen/hid/open_error.hpp"

namespace riffler::test {

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
