// Tokens and numbers of text files, with the line for messages.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "riffler/geom/vec.hpp"

namespace riffler::mesh {

/// The number that `token` spells in full, a leading '+' allowed; what is too small for a double is 0. Nothing for
/// anything else, among it NaN and infinity.
std::optional<double> to_number(std::string_view token);
std::optional<std::int64_t> to_integer(std::string_view token);
/// What the many ways of writing a number that is none look like: nan, -inf, 1.#QNAN, …
bool is_not_a_number(std::string_view token);
/// `token` between quotes, shortened, without bytes that a terminal would act on.
std::string in_quotes(std::string_view token);
bool equal_ignoring_case(std::string_view a, std::string_view b);

/// Reads a text from front to back. CR, LF and CR LF end a line.
class Scanner {
 public:
  /// `name` stands in messages; `text` must outlive the scanner. From line 1 on a UTF-8 byte order mark is skipped.
  Scanner(std::span<const std::uint8_t> text, std::string name, std::size_t line = 1);

  /// The next token, on this line or a later one; empty at the end of the text.
  std::string_view token();
  /// The next token of this line; empty at its end.
  std::string_view token_in_line();
  /// Skips what is left of this line and its end.
  void next_line();
  bool at_end() const { return at_ == text_.size(); }

  /// The next token, which must be `word` in whatever case.
  void expect(std::string_view word);
  /// The next token as a number; `what` stands in the message if it is none.
  double number(const char* what);
  /// Skips a number of which nothing is needed; NaN, infinity and decimal commas pass.
  void skip_number(const char* what);
  /// Three numbers that are fit for a vertex: |x| ≤ 1e30.
  Vec3 vertex();

  /// 1-based line of the last token.
  std::size_t line() const { return line_; }
  std::size_t offset() const { return at_; }
  [[noreturn]] void fail(const std::string& what) const;
  /// fail("expected …, found …"), or "the file ends where … was expected".
  [[noreturn]] void fail_expected(const std::string& expected, std::string_view found) const;

 private:
  std::string_view text_;
  std::string name_;
  std::size_t at_ = 0, line_;
};

}  // namespace riffler::mesh
