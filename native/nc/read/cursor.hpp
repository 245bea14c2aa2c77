// The characters of one block: blanks and comments between its parts, numbers and names.
#pragma once

#include <string>
#include <string_view>

#include "nc/source.hpp"

namespace riffler::nc {

class NcCursor {
 public:
  /// Keeps `place`, which stands in messages.
  NcCursor(std::string_view text, const NcPlace& place)
      : at_(text.data()), end_(text.data() + text.size()), place_(place) {}

  /// The next character after blanks and comments, upper case, which is not taken; '\0' at the end.
  char peek() {
    while (at_ != end_ && (*at_ == ' ' || *at_ == '\t')) ++at_;
    if (at_ == end_) return '\0';
    if (*at_ == '(' || *at_ == ';') return skip_comment();
    if (*at_ == '\0') fail_character();
    return upper(*at_);
  }
  void take() { ++at_; }
  /// Takes `c` where it comes next.
  bool take_if(char c) {
    if (peek() != c) return false;
    take();
    return true;
  }
  /// Takes `word` (upper case) where it comes next, in any case.
  bool take_word(std::string_view word);
  /// The letters that come next, upper case; taken.
  std::string letters();

  /// Whether a number comes next: a digit or a point, after a sign or none.
  bool at_number();
  /// Takes a decimal number with an optional sign, without an exponent. `what` ("X") stands in messages.
  double number(char what);
  /// Takes "name>" after "<": lower case, without blanks.
  std::string name();

  [[noreturn]] void fail(const std::string& what) const { place_.fail(what); }
  /// Of the character that comes next.
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
