// Splits the text of an APT file into statements.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "nc/source.hpp"

namespace riffler::nc {

/// MAJOR/minor,…: words in upper case without blanks; `text` verbatim, for text statements.
struct AptStatement {
  int line = 0;  ///< line at which it begins
  std::string major;
  std::vector<std::string> words;
  std::string text;
};

/// A statement is a line; $ continues it on the next line, $$ does not; the rest of the line is a comment. A comment
/// that begins with $$-> continues if its line ends with a $.
class AptLexer {
 public:
  /// Keeps references to `text` and `place`, and updates `place`.
  AptLexer(std::string_view text, NcPlace& place) : source_(text, place.file), place_(place) {}

  /// The next statement; false at the end. Throws FormatError if the text ends within a statement.
  bool next(AptStatement& statement);

  /// Fraction of the text read so far, 0 to 1.
  double share() const { return source_.share(); }

  /// The word as a number; no value if it is none. Throws FormatError if it is out of range.
  std::optional<double> number(std::string_view word) const;

 private:
  NcSource source_;
  NcPlace& place_;
};

}  // namespace riffler::nc
