// Numbers and comments as NC code has them.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

namespace riffler::nc {

inline constexpr int kLengthDecimals = 5, kAngleDecimals = 6, kFeedDecimals = 6;
/// No value in print.
inline constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::min();

/// `value` in units of its last printed decimal: what is equal here is equal in print.
std::int64_t ticks(double value, int decimals);
/// Fixed decimals; `trim` drops zeros at the end and a bare point.
void put_ticks(std::string& out, std::int64_t value, int decimals, bool trim = false);
/// `value` with at most so many decimals, for comments.
std::string number_text(double value, int decimals = 6);

/// Text that is safe inside a comment on any control: printable ASCII without brackets, not too long.
std::string plain(std::string_view text);

}  // namespace riffler::nc
