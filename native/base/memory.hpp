// Refusals of work that does not fit in memory.
#pragma once

#include <cstddef>
#include <cstdio>
#include <iterator>
#include <stdexcept>
#include <string>

namespace riffler::base {

/// Formats a number of bytes for a message: 7.28e12 → "7.3 TB".
inline std::string in_bytes(double count) {
  const char* const units[] = {"bytes", "kB", "MB", "GB", "TB"};
  std::size_t unit = 0;
  for (; count >= 999.5 && unit + 1 < std::size(units); count /= 1000) ++unit;
  char out[64];
  std::snprintf(out, sizeof out, unit == 0 || count >= 99.95 ? "%.0f %s" : "%.1f %s", count, units[unit]);
  return out;
}

/// Throws std::invalid_argument "WHAT needs 38 GB, and 20 GB are free: REMEDY" if `needed` bytes are more than `free`.
inline void require_memory(double needed, double free, const std::string& what, const std::string& remedy) {
  if (needed > free)
    throw std::invalid_argument(what + " needs " + in_bytes(needed) + ", and " + in_bytes(free) +
                                " are free: " + remedy);
}

}  // namespace riffler::base
