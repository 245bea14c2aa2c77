// Bounds of the numbers that calls are given, in one place. What is beyond makes no sense as a size of tools and parts,
// and would ask for work without end. (Of programs and NC code: nc/limits.hpp.)
#pragma once

#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <string_view>

namespace riffler {

inline constexpr double kMinTolerance = 1e-8;         // mm: of cutting and planning
inline constexpr double kMinToleranceOfSize = 1e-10;  // and as a share of the tool's size: doubles have no more to give
inline constexpr double kMaxSize = 1e30;              // mm: of tolerances and distances
inline constexpr double kMaxBox = 1e7;                // mm: a side of a volume's box, 10 km
inline constexpr double kMinTime = 1e-12;             // s: of a move
inline constexpr double kMaxTime = 1e12;              // s
inline constexpr double kMaxTurn = 1e6;               // rad: beyond, sines are noise
inline constexpr double kMaxConstant = 1e12;          // of materials: N·s/mm³ and the like

/// A number as messages have it.
inline std::string in_figures(double value) {
  char out[32];
  std::snprintf(out, sizeof out, "%g", value);
  return out;
}

/// std::invalid_argument naming the number unless it is finite.
inline void require_finite(double x, std::string_view name) {
  if (!std::isfinite(x)) throw std::invalid_argument(std::string(name) + " must be finite, not " + in_figures(x));
}

/// std::invalid_argument unless low ≤ x ≤ high. `what` and `unit`: "a positive length" and "mm".
inline void require_between(double x, double low, double high, std::string_view name, const char* what,
                            const char* unit) {
  if (x >= low && x <= high) return;
  throw std::invalid_argument(std::string(name) + " must be " + what + " in " + unit + ", from " + in_figures(low) +
                              " to " + in_figures(high) + ", not " + in_figures(x));
}

/// A tolerance of cutting: mm.
inline void require_tolerance(double x, std::string_view name = "tolerance") {
  require_between(x, kMinTolerance, kMaxSize, name, "a positive length", "mm");
}

/// Of a call with a tool (or a part) of that size, mm.
inline void require_tolerance_for(double tolerance, double size) {
  if (!(tolerance >= kMinToleranceOfSize * size))
    throw std::invalid_argument("tolerance must be a positive length in mm, at least 1e-10 of the tool's size");
}

/// A time in s, of a move.
inline void require_time(double x, std::string_view name) {
  require_between(x, kMinTime, kMaxTime, name, "a positive time", "s");
}

/// An angle in rad, of either sign.
inline void require_angle(double x, std::string_view name) {
  require_between(x, -kMaxTurn, kMaxTurn, name, "an angle", "rad");
}

}  // namespace riffler
