// Splits text files into tokens and numbers, with line numbers for messages.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "riffler/geom/vec.hpp"

namespace riffler::mesh {

/// The number that the whole of `token` spells; a leading '+' is allowed, and a value too small for a double gives 0.
/// Nothing for any other token, including NaN and infinity.
std::optional<double> to_number(std::string_view token);
std::optional<std::int64_t> to_integer(std::string_view token);
/// Whether `token` is one of the many spellings of NaN or infinity: nan, -inf, 1.#QNAN, …
bool is_not_a_number(std::string_view token);
/// `token` in quotes, shortened, without control bytes that a terminal would interpret.
std::string in_quotes(std::string_view token);
bool equal_ignoring_case(std::string_view a, std::string_view b);

/// Reads a text from front to back. CR, LF or CR LF end a line.
class Scanner {
 public:
  /// `name` appears in messages; `text` must outlive the scanner. At line 1, skips a UTF-8 byte order mark.
  Scanner(std::span<const std::uint8_t> text, std::string name, std::size_t line = 1);

  /// The next token, on this line or a later one; empty at the end of the text.
  std::string_view token();
  /// The next token of this line; empty at its end.
  std::string_view token_in_line();
  /// Skips the rest of this line and its end.
  void next_line();
  bool at_end() const { return at_ == text_.size(); }

  /// Reads a token that must be `word`, in upper or lower case.
  void expect(std::string_view word);
  /// Reads a token that must be a number; `what` names it in the message.
  double number(const char* what);
  /// Skips a number whose value is not used; accepts NaN, infinity and decimal commas.
  void skip_number(const char* what);
  /// Reads three numbers that are valid vertex coordinates: |x| ≤ 1e30.
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
