// Limits on numbers in programs and NC code. Larger values are errors: the reader rejects them, the writer does not
// write them, and sums of two such values keep the printed decimals in a double.
#pragma once

#include <cstddef>

namespace riffler::nc {

inline constexpr double kInch = 25.4;  // mm

inline constexpr double kMaxLength = 1e6;      // mm: a kilometre; a double resolves 1e-10 mm there
inline constexpr double kMaxAngle = 1e8;       // deg: rotary axes may count turns
inline constexpr double kMaxFeed = 1e9;        // mm/min, or 1/min under G93
inline constexpr double kMinFeed = 1e-6;       // mm/min, for rapids: a mm in 2000 years
inline constexpr double kMaxMinutes = 1e9;     // duration of a move
inline constexpr double kMaxSpindle = 1e7;     // rev/min
inline constexpr int kMaxNumber = 99'999'999;  // tools, offsets, block numbers

// Bounds on memory and time for corrupt numbers.
inline constexpr int kMaxChords = 1'000'000;         // per block
inline constexpr double kLinesOfTurn = 100;          // lines read again, on average, per loop turn or call
inline constexpr std::size_t kMaxRows = 20'000'000;  // of a program read as a whole

}  // namespace riffler::nc
