// What the settings of the haptic step have in common: bounds that are checked once, with the field's name.
#pragma once

#include <cmath>
#include <stdexcept>
#include <string>

namespace riffler {

/// A bound on translation and its sister on rotation: they have no common unit.
struct Bounds {
  double linear, angular;

  double operator[](int coordinate) const { return coordinate < 3 ? linear : angular; }
};

/// std::invalid_argument naming `field` unless `value` is finite and in [low, high]; high may be infinite.
inline void require_between(const char* field, double value, double low, double high) {
  if (std::isfinite(value) && value >= low && value <= high) return;
  std::string range = "of at least " + std::to_string(low);
  if (std::isfinite(high)) range = "between " + std::to_string(low) + " and " + std::to_string(high);
  throw std::invalid_argument(std::string(field) + " must be a number " + range);
}

inline void require_positive(const char* field, double value) {
  if (!std::isfinite(value) || value <= 0) throw std::invalid_argument(std::string(field) + " must be positive");
}

/// Zero is allowed: it switches off what is bounded.
inline void require_not_negative(const char* field, double value) {
  if (!std::isfinite(value) || value < 0) throw std::invalid_argument(std::string(field) + " must not be negative");
}

}  // namespace riffler
