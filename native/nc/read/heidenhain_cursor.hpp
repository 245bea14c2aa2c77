// The characters of one block of a Heidenhain conversational program: words, numbers, quoted names.
#pragma once

#include <string>
#include <string_view>

#include "nc/read/cursor.hpp"
#include "nc/source.hpp"

namespace riffler::nc {

/// A block may run over several lines, each with a comment of its own: line ends, "~" and comments are blanks.
class HeidenhainCursor {
 public:
  /// Keeps `place`, which stands in messages.
  HeidenhainCursor(std::string_view text, const NcPlace& place)
      : at_(text.data()), end_(text.data() + text.size()), place_(place) {}

  /// The next character after blanks, upper case, not taken; '\0' at the end.
  char peek();
  void take() { ++at_; }
  /// Takes `c` where it comes next.
  bool take_if(char c) {
    if (peek() != c) return false;
    take();
    return true;
  }
  /// Takes `word` (upper case) where it comes next, in any case. A blank in it stands for any number of blanks.
  bool take_word(std::string_view word);
  /// The letters that come next, upper case; taken.
  std::string letters();
  /// Whether a number comes next: a digit or a decimal point or comma, after no sign.
  bool at_number();
  /// Takes a decimal number without a sign. `what` stands in messages.
  double number(std::string_view what);
  /// Takes the text between quotes, as it is; the opening quote comes next.
  std::string quoted();
  void skip_line() {
    while (at_ != end_ && *at_ != '\n') ++at_;
  }
  /// What is left, as it is, without taking it.
  std::string_view rest() const { return {at_, static_cast<std::size_t>(end_ - at_)}; }

  [[noreturn]] void fail(const std::string& what) const { place_.fail(what); }
  /// Of what comes next: FormatError "unexpected '…'".
  [[noreturn]] void fail_unexpected();

 private:
  const char *at_, *end_;
  const NcPlace& place_;
};

}  // namespace riffler::nc
