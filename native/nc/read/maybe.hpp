// Calculations with values that may be unknown.
#pragma once

#include <optional>

namespace riffler::nc {

/// `of` applied to both values; no value if one of them is unknown.
template <typename Of>
std::optional<double> both(const std::optional<double>& a, const std::optional<double>& b, Of of) {
  return a && b ? std::optional<double>(of(*a, *b)) : std::nullopt;
}

}  // namespace riffler::nc
