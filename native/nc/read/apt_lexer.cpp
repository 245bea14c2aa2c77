#include "nc/read/apt_lexer.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "nc/read/cursor.hpp"

namespace riffler::nc {

namespace {

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t"), last = text.find_last_not_of(" \t");
  return first == text.npos ? std::string_view() : text.substr(first, last - first + 1);
}

std::string compact(std::string_view text) {
  std::string out;
  for (const char c : text)
    if (c != ' ' && c != '\t') out += NcCursor::upper(c);
  return out;
}

/// Statements of text up to the end of the line, in which $ has no meaning.
bool is_text(std::string_view line) {
  const std::string start = compact(line.substr(0, 12));
  return start.starts_with("PARTNO") || start.starts_with("PPRINT") || start.starts_with("INSERT");
}

}  // namespace

bool AptLexer::next(AptStatement& statement) {
  statement = {};
  std::string whole;
  std::string_view line;
  bool more = false, comment = false;
  while (source_.next(line)) {
    place_.line = source_.line(), place_.text = line;
    std::string_view part = trimmed(line);
    // Creo's meaningful comments continue behind a $, as statements do.
    if (!more && (comment || part.starts_with("$$->"))) {
      comment = part.ends_with('$') && part != "$$";
      continue;
    }
    if (!more && is_text(part)) {
      statement.line = place_.line;
      statement.major = compact(part.substr(0, 6));
      statement.text = trimmed(part.substr(std::min<std::size_t>(6, part.size())));
      if (statement.text.starts_with('/')) statement.text = trimmed(std::string_view(statement.text).substr(1));
      return true;
    }
    // A comment follows $; a single $ also continues the statement.
    const std::size_t end = part.find('$');
    const bool continues = end != part.npos && part.substr(end, 2) != "$$";
    part = trimmed(part.substr(0, end));
    if (part.empty() && !continues && !more) continue;
    if (!more) statement.line = place_.line;
    more = continues;
    whole += part;
    if (!more) break;
  }
  if (more) place_.fail("the file ends within a statement that $ continues");
  if (whole.empty()) return false;
  for (const char c : whole)
    if ((c < ' ' && c != '\t') || c > '~') place_.fail("a character outside ASCII, or none that is printed");
  const std::size_t slash = whole.find('/');
  statement.major = compact(std::string_view(whole).substr(0, slash));
  if (slash == whole.npos) return true;
  statement.text = trimmed(std::string_view(whole).substr(slash + 1));
  std::string_view rest = statement.text;
  while (true) {
    const std::size_t comma = rest.find(',');
    statement.words.push_back(compact(rest.substr(0, comma)));
    if (comma == rest.npos) return true;
    rest.remove_prefix(comma + 1);
  }
}

std::optional<double> AptLexer::number(std::string_view word) const {
  if (word.starts_with('+')) word.remove_prefix(1);
  if (word.empty() || !(NcCursor::is_digit(word[0]) || word[0] == '.' || word[0] == '-')) return std::nullopt;
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size()) return std::nullopt;
  if (error != std::errc() || !std::isfinite(value)) place_.fail("a number out of range: " + std::string(word));
  return value;
}

}  // namespace riffler::nc
