// Constants of geometry, once for every topic.
#pragma once

#include <limits>
#include <numbers>

namespace riffler {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kTwoPi = 2 * kPi;     ///< rad of a whole turn
inline constexpr double kDegree = kPi / 180;  ///< rad of one degree
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace riffler
