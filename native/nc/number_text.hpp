// Numbers and comments in NC code.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

namespace riffler::nc {

inline constexpr int kLengthDecimals = 5, kAngleDecimals = 6, kFeedDecimals = 6;
/// A tick count that no printed value has.
inline constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::min();

/// `value` in units of its last printed decimal: equal ticks print equally.
std::int64_t ticks(double value, int decimals);
/// Appends ticks with a fixed number of decimals; `trim` drops trailing zeros and a bare point.
void put_ticks(std::string& out, std::int64_t value, int decimals, bool trim = false);
/// `value` with at most `decimals` decimals, for comments.
std::string number_text(double value, int decimals = 6);

/// Text that is safe in a comment on any control: printable ASCII without brackets, limited in length.
std::string plain(std::string_view text);

}  // namespace riffler::nc
