// Units of length in NC code.
#pragma once

namespace riffler {

inline constexpr double kInch = 25.4;  // mm

}  // namespace riffler
