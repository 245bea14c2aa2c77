// NC text → blocks of words. What a word means is the reader's business.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace riffler {

struct NcWord {
  char letter;  ///< upper case
  double value;
};

/// What one line holds apart from comments.
struct NcBlock {
  int line = 0;          ///< 1-based
  bool percent = false;  ///< the line is a lone %
  std::vector<NcWord> words;
};

/// Blanks may stand between letter and number; numbers are decimal with an optional sign, without an exponent. Comments
/// are (…) within a line and ; to its end, of any bytes; outside them only ASCII. Lines end in LF or CR LF.
class NcLexer {
 public:
  /// Keeps `text`, which must outlive it; `file` (base name) stands in messages.
  NcLexer(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {}

  /// The next line that holds words or a %; false at the end. FormatError names the line.
  bool next(NcBlock& block);

  /// Throws FormatError for the line of the last block.
  [[noreturn]] void fail(const std::string& what) const;

 private:
  void skip_comment();
  double number(char letter);

  std::string_view text_;
  std::string file_;
  std::size_t at_ = 0;
  int line_ = 0;
};

}  // namespace riffler
