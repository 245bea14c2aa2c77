// Parsing of the stress runs' command lines.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <string_view>

namespace riffler::stress {

/// The number in `text`, all of which strtod must read. Throws std::invalid_argument naming the option.
inline double number(std::string_view name, const char* text) {
  char* end = nullptr;
  const double value = text ? std::strtod(text, &end) : 0;
  if (!text || end == text || *end != '\0') throw std::invalid_argument(std::string(name) + " needs a number");
  return value;
}

inline std::uint64_t whole_number(std::string_view name, const char* text) {
  char* end = nullptr;
  const unsigned long long value = text ? std::strtoull(text, &end, 10) : 0;
  if (!text || end == text || *end != '\0') throw std::invalid_argument(std::string(name) + " needs a whole number");
  return value;
}

/// Whether an option is a flag, has a value in the next word, or is unknown.
enum class Takes { Flag, Value, Unknown };

/// Calls `take(option, value)` for each option, with null for a missing value. Throws std::invalid_argument naming an
/// option that is unknown or whose value is missing.
template <class Take>
void each_option(int argc, char** argv, Take&& take) {
  for (int k = 1; k < argc; ++k) {
    const std::string_view option = argv[k];
    const char* const value = k + 1 < argc ? argv[k + 1] : nullptr;
    const Takes takes = take(option, value);
    if (takes == Takes::Unknown || (takes == Takes::Value && !value))
      throw std::invalid_argument("unknown or incomplete option " + std::string(option));
    if (takes == Takes::Value) ++k;
  }
}

}  // namespace riffler::stress
