// The characters of one block of a Sinumerik program: names, numbers, texts in quotes.
#pragma once

#include <string>
#include <string_view>

#include "nc/read/cursor.hpp"
#include "nc/source.hpp"

namespace riffler::nc {

/// Brackets hold arguments here, no comments; a comment begins with ";".
class SinumerikCursor {
 public:
  /// Keeps `place`, which stands in messages.
  SinumerikCursor(std::string_view text, const NcPlace& place) : rest_(text), place_(&place) {}

  /// The next character after blanks, upper case, not taken; '\0' at the end.
  char peek();
  void take() { rest_.remove_prefix(1); }
  /// Takes `symbol` where it comes next: one character or several.
  bool take_if(std::string_view symbol);
  /// Takes the name `word` (upper case) where it comes next as a whole.
  bool take_word(std::string_view word);
  /// Whether the next word is an address, a letter with its value ("X10", "X=R1"), not a name ("TRAORI").
  bool at_address();
  /// Whether a number comes next: a digit or a decimal point, after no sign.
  bool at_number();
  /// Takes a name, upper case: letters, digits, _ and $. Empty where none comes next.
  std::string name();
  /// Takes a decimal number without a sign, which may have an exponent ("1.5EX3"). `what` stands in messages.
  double number(std::string_view what);
  /// The digits that come next without a blank before them; taken.
  std::string digits();
  /// Takes the text between quotes; the opening quote comes next.
  std::string quoted();
  /// Takes everything up to the bracket that closes the one that was taken.
  void skip_brackets();
  void skip_all() { rest_ = {}; }

  /// FormatError unless the block ends here.
  void expect_end();
  [[noreturn]] void fail(const std::string& what) const { place_->fail(what); }
  /// Of what comes next: FormatError "unexpected '...'".
  [[noreturn]] void fail_unexpected();

 private:
  static bool is_of_name(char c) { return NcCursor::is_letter(c) || NcCursor::is_digit(c) || c == '_' || c == '$'; }

  std::string_view rest_;
  const NcPlace* place_;
};

}  // namespace riffler::nc
