// Text of an APT file → statements.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "nc/source.hpp"

namespace riffler::nc {

/// MAJOR/minor,…: the words upper case without blanks; `text` as it stands, for statements that are text.
struct AptStatement {
  int line = 0;  ///< where it begins
  std::string major;
  std::vector<std::string> words;
  std::string text;
};

/// A statement is a line; $ continues it on the next line, $$ does not; what follows either is a comment. A comment
/// that begins with $$-> goes on where its line ends with a $.
class AptLexer {
 public:
  /// Keeps `text` and `place`, in which it says where it is.
  AptLexer(std::string_view text, NcPlace& place) : source_(text, place.file), place_(place) {}

  /// The next statement; false at the end. FormatError where the text ends within one.
  bool next(AptStatement& statement);

  /// Of the text, how much has been read, in [0, 1].
  double share() const { return source_.share(); }

  /// The word as a number; nothing where it is none. FormatError where it is out of range.
  std::optional<double> number(std::string_view word) const;

 private:
  NcSource source_;
  NcPlace& place_;
};

}  // namespace riffler::nc
