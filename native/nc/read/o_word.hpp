// O-words: what they are called, and lines that begin with one.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace riffler::nc {

enum class NcKeyword : std::uint8_t {
  None,
  Sub,
  EndSub,
  Call,
  Return,
  If,
  ElseIf,
  Else,
  EndIf,
  While,
  EndWhile,
  Do,
  Repeat,
  EndRepeat,
  Break,
  Continue
};

/// Of the letters after a label, upper case; nothing for unknown ones. No letters: None.
std::optional<NcKeyword> nc_keyword(std::string_view text);

struct NcOLine {
  std::string label;  ///< a number without leading zeros, or a name in lower case without blanks
  NcKeyword keyword;
  std::string_view rest;  ///< of the line
};

/// A line that begins with an O-word whose label is written out, as it is seen while lines are passed over: nothing
/// else in them is judged.
std::optional<NcOLine> nc_o_line(std::string_view line);

}  // namespace riffler::nc
