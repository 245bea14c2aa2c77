#include "nc/lexer.hpp"

#include <charconv>
#include <cmath>
#include <cstdio>

#include "geom/error.hpp"

namespace riffler {

namespace {

// <cctype> depends on the locale.
bool is_letter(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
char upper(char c) {
  return c >= 'a' ? static_cast<char>(c - 'a' + 'A') : c;
}
bool is_blank(char c) {
  return c == ' ' || c == '\t';
}

std::string show(char c) {
  if (c > ' ' && c <= '~') return std::string("'") + c + "'";
  char text[16];
  std::snprintf(text, sizeof text, "byte 0x%02X", static_cast<unsigned char>(c));
  return text;
}

}  // namespace

void NcLexer::fail(const std::string& what) const {
  throw FormatError(file_, "line " + std::to_string(line_), what);
}

void NcLexer::skip_comment() {
  for (++at_; at_ < text_.size() && text_[at_] != '\n'; ++at_) {
    if (text_[at_] == '(') fail("a comment within a comment");
    if (text_[at_] == ')') {
      ++at_;
      return;
    }
  }
  fail("unclosed comment");
}

double NcLexer::number(char letter) {
  while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
  bool negative = false;
  if (at_ < text_.size() && (text_[at_] == '+' || text_[at_] == '-')) negative = text_[at_++] == '-';
  const std::size_t begin = at_;
  bool digits = false, point = false;
  for (; at_ < text_.size(); ++at_) {
    if (is_digit(text_[at_]))
      digits = true;
    else if (text_[at_] == '.' && !point)
      point = true;
    else
      break;
  }
  if (!digits) fail(std::string("expected a number after ") + letter);
  double value = 0;
  const auto [end, error] = std::from_chars(text_.data() + begin, text_.data() + at_, value, std::chars_format::fixed);
  // Too many leading or trailing zeros may count as out of range too; no sensible program has 300 digits.
  if (error != std::errc() || end != text_.data() + at_)
    fail(std::string("the number after ") + letter + " is out of range");
  return negative ? -value : value;
}

bool NcLexer::next(NcBlock& block) {
  block.words.clear();
  block.percent = false;
  while (at_ < text_.size()) {
    block.line = ++line_;
    // One line.
    while (at_ < text_.size() && text_[at_] != '\n') {
      const char c = text_[at_];
      if (is_letter(c)) {
        if (block.percent) fail("text beside %");
        ++at_;
        block.words.push_back({upper(c), 0});
        block.words.back().value = number(block.words.back().letter);
      } else if (is_blank(c)) {
        ++at_;
      } else if (c == '(') {
        skip_comment();
      } else if (c == ';') {
        at_ = std::min(text_.find('\n', at_), text_.size());
      } else if (c == '\r' && (at_ + 1 == text_.size() || text_[at_ + 1] == '\n')) {
        ++at_;
      } else if (c == '%' && !block.percent && block.words.empty()) {
        ++at_;
        block.percent = true;
      } else if (static_cast<unsigned char>(c) >= 0x80) {
        fail("a character outside ASCII (" + show(c) + ")");
      } else {
        fail("unexpected " + show(c));
      }
    }
    if (at_ < text_.size()) ++at_;
    if (block.percent || !block.words.empty()) return true;
  }
  return false;
}

}  // namespace riffler
