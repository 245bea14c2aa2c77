// Cursor over one block of a Heidenhain program: words, numbers, quoted names.
#pragma once

#include <string>
#include <string_view>

#include "nc/read/cursor.hpp"
#include "nc/source.hpp"

namespace riffler::nc {

/// A block may span several lines, each with its own comment: line ends, "~" and comments count as blanks.
class HeidenhainCursor {
 public:
  /// Keeps a reference to `place`, which appears in messages.
  HeidenhainCursor(std::string_view text, const NcPlace& place)
      : at_(text.data()), end_(text.data() + text.size()), place_(place) {}

  /// The next character after blanks, upper case, not consumed; '\0' at the end.
  char peek();
  void take() { ++at_; }
  /// Consumes `c` if it comes next.
  bool take_if(char c) {
    if (peek() != c) return false;
    take();
    return true;
  }
  /// Consumes `word` (upper case) if it comes next, in any case. A blank in it matches any number of blanks.
  bool take_word(std::string_view word);
  /// Consumes and returns the next letters, upper case.
  std::string letters();
  /// Whether an unsigned number comes next: a digit, or a decimal point or comma.
  bool at_number();
  /// Reads a decimal number without a sign. `what` appears in messages.
  double number(std::string_view what);
  /// Reads the text between quotes verbatim; the opening quote comes next.
  std::string quoted();
  void skip_line() {
    while (at_ != end_ && *at_ != '\n') ++at_;
  }
  /// The rest of the block verbatim, not consumed.
  std::string_view rest() const { return {at_, static_cast<std::size_t>(end_ - at_)}; }

  [[noreturn]] void fail(const std::string& what) const { place_.fail(what); }
  /// Throws FormatError "unexpected '…'" for what comes next.
  [[noreturn]] void fail_unexpected();

 private:
  const char *at_, *end_;
  const NcPlace& place_;
};

}  // namespace riffler::nc
