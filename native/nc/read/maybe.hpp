// Calculations with values that may not be known.
#pragma once

#include <optional>

namespace riffler::nc {

/// `of` both values; nothing where one of them is not known.
template <typename Of>
std::optional<double> both(const std::optional<double>& a, const std::optional<double>& b, Of of) {
  return a && b ? std::optional<double>(of(*a, *b)) : std::nullopt;
}

}  // namespace riffler::nc
