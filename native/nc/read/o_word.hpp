// O-words: their keywords, and lines that begin with one.
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

/// The keyword of the letters after a label, in upper case; no value for unknown ones. No letters: None.
std::optional<NcKeyword> nc_keyword(std::string_view text);

struct NcOLine {
  std::string label;  ///< a number without leading zeros, or a name in lower case without blanks
  NcKeyword keyword;
  std::string_view rest;  ///< rest of the line
};

/// Parses a line that begins with an O-word with a literal label, for skipping; nothing else in it is checked.
std::optional<NcOLine> nc_o_line(std::string_view line);

}  // namespace riffler::nc
