// Pairs of bounds for the haptic settings, and their checks.
#pragma once

#include <string>

#include "riffler/base/check.hpp"

namespace riffler::haptics {

/// Two bounds, one for translation and one for rotation, since the two have no common unit.
struct Bounds {
  double linear, angular;

  double operator[](int coordinate) const { return coordinate < 3 ? linear : angular; }
};

/// Throws std::invalid_argument naming the bound that is not positive and finite: "NAME.linear must be positive".
inline void require_positive(const Bounds& b, const std::string& name) {
  base::require_positive(b.linear, name + ".linear"), base::require_positive(b.angular, name + ".angular");
}

/// As require_positive, but allows zero, which switches off what is bounded.
inline void require_not_negative(const Bounds& b, const std::string& name) {
  base::require_not_negative(b.linear, name + ".linear"), base::require_not_negative(b.angular, name + ".angular");
}

}  // namespace riffler::haptics
