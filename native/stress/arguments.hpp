// What the command lines of the stress runs share.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string>

namespace riffler::stress {

inline std::uint64_t whole_number(const char* name, const char* text) {
  char* end = nullptr;
  const unsigned long long value = text ? std::strtoull(text, &end, 10) : 0;
  if (!text || end == text || *end != '\0') throw std::invalid_argument(std::string(name) + " needs a whole number");
  return value;
}

}  // namespace riffler::stress
