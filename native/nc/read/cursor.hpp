// Cursor over one block: skips blanks and comments, reads numbers and names.
#pragma once

#include <string>
#include <string_view>

#include "nc/source.hpp"

namespace riffler::nc {

class NcCursor {
 public:
  /// Keeps a reference to `place`, which appears in messages.
  NcCursor(std::string_view text, const NcPlace& place)
      : at_(text.data()), end_(text.data() + text.size()), place_(place) {}

  /// The next character after blanks and comments, upper case, not consumed; '\0' at the end.
  char peek() {
    while (at_ != end_ && (*at_ == ' ' || *at_ == '\t')) ++at_;
    if (at_ == end_) return '\0';
    if (*at_ == '(' || *at_ == ';') return skip_comment();
    if (*at_ == '\0') fail_character();
    return upper(*at_);
  }
  void take() { ++at_; }
  /// Consumes `c` if it comes next.
  bool take_if(char c) {
    if (peek() != c) return false;
    take();
    return true;
  }
  /// Consumes `word` (upper case) if it comes next, in any case.
  bool take_word(std::string_view word);
  /// Consumes and returns the next letters, upper case.
  std::string letters();

  /// Whether a number comes next: a digit or a point, after an optional sign.
  bool at_number();
  /// Reads a decimal number with an optional sign, without an exponent. `what` ("X") appears in messages.
  double number(char what);
  /// Reads "name>" after "<": lower case, without blanks.
  std::string name();

  [[noreturn]] void fail(const std::string& what) const { place_.fail(what); }
  /// Throws for the next character.
  [[noreturn]] void fail_character() const;

  // <cctype> depends on the locale.
  static bool is_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }
  static bool is_digit(char c) { return c >= '0' && c <= '9'; }
  static char upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }
  static char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

 private:
  char skip_comment();

  const char *at_, *end_;
  const NcPlace& place_;
};

}  // namespace riffler::nc
