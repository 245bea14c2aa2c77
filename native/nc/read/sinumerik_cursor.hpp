// Cursor over one block of a Sinumerik program: names, numbers, quoted texts.
#pragma once

#include <string>
#include <string_view>

#include "nc/read/cursor.hpp"
#include "nc/source.hpp"

namespace riffler::nc {

/// Round brackets hold arguments, not comments; a comment begins with ";".
class SinumerikCursor {
 public:
  /// Keeps a pointer to `place`, which appears in messages.
  SinumerikCursor(std::string_view text, const NcPlace& place) : rest_(text), place_(&place) {}

  /// The next character after blanks, upper case, not consumed; '\0' at the end.
  char peek();
  void take() { rest_.remove_prefix(1); }
  /// Consumes `symbol`, of one or more characters, if it comes next.
  bool take_if(std::string_view symbol);
  /// Consumes the name `word` (upper case) if it comes next as a whole.
  bool take_word(std::string_view word);
  /// Whether the next word is an address, a letter with its value ("X10", "X=R1"), rather than a name ("TRAORI").
  bool at_address();
  /// Whether an unsigned number comes next: a digit or a decimal point.
  bool at_number();
  /// Reads a name, upper case: letters, digits, _ and $. Empty if none comes next.
  std::string name();
  /// Reads a decimal number without a sign, possibly with an exponent ("1.5EX3"). `what` appears in messages.
  double number(std::string_view what);
  /// Consumes the digits that follow immediately.
  std::string digits();
  /// Reads the text between quotes; the opening quote comes next.
  std::string quoted();
  /// Skips to the bracket that closes the one just consumed.
  void skip_brackets();
  void skip_all() { rest_ = {}; }

  /// Throws FormatError unless the block ends here.
  void expect_end();
  [[noreturn]] void fail(const std::string& what) const { place_->fail(what); }
  /// Throws FormatError "unexpected '...'" for what comes next.
  [[noreturn]] void fail_unexpected();

 private:
  static bool is_of_name(char c) { return NcCursor::is_letter(c) || NcCursor::is_digit(c) || c == '_' || c == '$'; }

  std::string_view rest_;
  const NcPlace* place_;
};

}  // namespace riffler::nc
