// Checks of arguments, and the bounds on numbers that several topics share. A number outside them makes no sense as the
// size of a tool or part, and could make a call run without end. (Bounds of programs and NC code: nc/limits.hpp.)
#pragma once

#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <string_view>

namespace riffler::base {

inline constexpr double kMinTolerance = 1e-8;         // mm, for cutting and planning
inline constexpr double kMinToleranceOfSize = 1e-10;  // as a fraction of the tool's size; doubles resolve no less
inline constexpr double kMaxSize = 1e30;              // mm, for tolerances and distances
inline constexpr double kMaxBox = 1e7;                // mm, a side of a volume's box: 10 km
inline constexpr double kMinTime = 1e-12;             // s, duration of a move
inline constexpr double kMaxTime = 1e12;              // s
inline constexpr double kMaxTurn = 1e6;               // rad; beyond it, rounding spoils sines
inline constexpr double kMaxConstant = 1e12;          // for material constants: N·s/mm³ and the like

/// Formats a number for a message.
inline std::string in_figures(double value) {
  char out[32];
  std::snprintf(out, sizeof out, "%g", value);
  return out;
}

/// Throws std::invalid_argument "NAME MUST" unless `good`. Example of `must`: "must be finite".
inline void require(bool good, std::string_view name, const char* must) {
  if (!good) throw std::invalid_argument(std::string(name) + " " + must);
}

inline constexpr const char* kPositiveAndFinite = "must be positive and finite";
inline constexpr const char* kFiniteAndNotNegative = "must be finite and not negative";

/// Throws std::invalid_argument "NAME MUST" unless x is positive and finite.
inline void require_positive(double x, std::string_view name, const char* must = "must be positive") {
  require(std::isfinite(x) && x > 0, name, must);
}

/// Throws std::invalid_argument "NAME MUST" unless x is finite and not negative.
inline void require_not_negative(double x, std::string_view name, const char* must = "must not be negative") {
  require(std::isfinite(x) && x >= 0, name, must);
}

/// Throws std::invalid_argument unless x is a positive, finite length in mm.
inline void require_length(double x, std::string_view name) {
  require_positive(x, name, "must be a positive length in mm");
}

/// Throws std::invalid_argument that contains the number, unless it is finite.
inline void require_finite(double x, std::string_view name) {
  if (!std::isfinite(x)) throw std::invalid_argument(std::string(name) + " must be finite, not " + in_figures(x));
}

/// Throws std::invalid_argument unless low ≤ x ≤ high. Examples of `what` and `unit`: "a positive length", "mm".
inline void require_between(double x, double low, double high, std::string_view name, const char* what,
                            const char* unit) {
  if (x >= low && x <= high) return;
  throw std::invalid_argument(std::string(name) + " must be " + what + " in " + unit + ", from " + in_figures(low) +
                              " to " + in_figures(high) + ", not " + in_figures(x));
}

/// Throws std::invalid_argument unless x is finite and in [low, high]; `high` may be infinite.
inline void require_between(double x, double low, double high, std::string_view name) {
  if (std::isfinite(x) && x >= low && x <= high) return;
  std::string range = "of at least " + std::to_string(low);
  if (std::isfinite(high)) range = "between " + std::to_string(low) + " and " + std::to_string(high);
  throw std::invalid_argument(std::string(name) + " must be a number " + range);
}

/// Checks a cutting tolerance, mm.
inline void require_tolerance(double x, std::string_view name = "tolerance") {
  require_between(x, kMinTolerance, kMaxSize, name, "a positive length", "mm");
}

/// Checks that a tolerance (mm) is not too small for a tool or part of this size (mm).
inline void require_tolerance_for(double tolerance, double size) {
  if (!(tolerance >= kMinToleranceOfSize * size))
    throw std::invalid_argument("tolerance must be a positive length in mm, at least 1e-10 of the tool's size");
}

/// Checks the duration of a move, s.
inline void require_time(double x, std::string_view name) {
  require_between(x, kMinTime, kMaxTime, name, "a positive time", "s");
}

/// Checks an angle of either sign, rad.
inline void require_angle(double x, std::string_view name) {
  require_between(x, -kMaxTurn, kMaxTurn, name, "an angle", "rad");
}

}  // namespace riffler::base
