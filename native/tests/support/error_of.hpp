// What a call refuses, as its caller reads it.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>

namespace riffler::test {

/// The message of the std::invalid_argument that `call` throws, or `otherwise`.
inline std::string error_of(const std::function<void()>& call, std::string otherwise = "") {
  try {
    call();
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return otherwise;
}

}  // namespace riffler::test
