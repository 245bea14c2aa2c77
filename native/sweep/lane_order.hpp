// Tables that gather some lanes of a vector at its front, and put them back.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "base/lanes.hpp"

namespace riffler::sweep {

/// For each mask of lanes, one bit each: the lane that each lane's value comes from.
using LaneOrders = std::array<std::array<std::int64_t, base::kLanes>, std::size_t{1} << base::kLanes>;

/// The lanes of the mask come first, in order; what follows is arbitrary.
inline constexpr LaneOrders kGathered = [] {
  LaneOrders out{};
  for (unsigned mask = 0; mask < out.size(); ++mask) {
    std::size_t at = 0;
    for (unsigned rest = mask; rest; rest &= rest - 1) out[mask][at++] = std::countr_zero(rest);
  }
  return out;
}();

/// Values at the front return to the lanes of the mask; the other lanes are arbitrary.
inline constexpr LaneOrders kSpread = [] {
  LaneOrders out{};
  for (unsigned mask = 0; mask < out.size(); ++mask)
    for (std::size_t k = 0; k < base::kLanes; ++k) {
      const int before = std::popcount(mask & ((1U << k) - 1));
      out[mask][k] = before < base::kLanes ? before : 0;
    }
  return out;
}();

}  // namespace riffler::sweep
