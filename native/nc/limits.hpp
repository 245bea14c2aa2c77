// Numbers that programs and NC code may hold: what is beyond is a mistake. The reader refuses it, the writer does not
// write it, and no sum of two of them leaves the range in which doubles keep the printed decimals.
#pragma once

#include <cstddef>

namespace riffler::nc {

inline constexpr double kInch = 25.4;  // mm

inline constexpr double kMaxLength = 1e6;      // mm: a kilometre, with 1e-10 mm to spare in a double
inline constexpr double kMaxAngle = 1e8;       // deg: rotary axes may count turns
inline constexpr double kMaxFeed = 1e9;        // mm/min, or 1/min under G93
inline constexpr double kMinFeed = 1e-6;       // mm/min of rapids: a mm in 2000 years
inline constexpr double kMaxMinutes = 1e9;     // of a move
inline constexpr double kMaxSpindle = 1e7;     // rev/min
inline constexpr int kMaxNumber = 99'999'999;  // tools, offsets, block numbers

// Bounds on memory and time against damaged numbers.
inline constexpr int kMaxChords = 1'000'000;         // of one block
inline constexpr double kLinesOfTurn = 100;          // that are read again, on average, in a turn of a loop or call
inline constexpr std::size_t kMaxRows = 20'000'000;  // of a program that is read at once

}  // namespace riffler::nc
