#include "nc/read/heidenhain_cursor.hpp"

#include <charconv>
#include <cmath>

namespace riffler::nc {

namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '~';
}

}  // namespace

char HeidenhainCursor::peek() {
  while (at_ != end_) {
    if (*at_ == ';')
      while (at_ != end_ && *at_ != '\n') ++at_;
    else if (is_blank(*at_))
      ++at_;
    else
      return *at_ == '\0' ? '?' : NcCursor::upper(*at_);
  }
  return '\0';
}

bool HeidenhainCursor::take_word(std::string_view word) {
  const char* const start = at_;
  peek();
  for (const char c : word) {
    if (c == ' ') {
      peek();
    } else if (at_ != end_ && NcCursor::upper(*at_) == c) {
      ++at_;
    } else {
      at_ = start;
      return false;
    }
  }
  return true;
}

std::string HeidenhainCursor::letters() {
  std::string out;
  peek();
  while (at_ != end_ && NcCursor::is_letter(*at_)) out += NcCursor::upper(*at_++);
  return out;
}

bool HeidenhainCursor::at_number() {
  const char c = peek();
  if (NcCursor::is_digit(c)) return true;
  return (c == '.' || c == ',') && at_ + 1 != end_ && NcCursor::is_digit(at_[1]);
}

double HeidenhainCursor::number(std::string_view what) {
  if (!at_number()) fail(std::string(what) + " without a number");
  constexpr std::size_t kDigits = 64;
  std::string text;
  bool point = false;
  for (; at_ != end_ && text.size() <= kDigits; ++at_) {
    const bool mark = *at_ == '.' || *at_ == ',';
    if (!NcCursor::is_digit(*at_) && !(mark && !point)) break;
    point |= mark;
    text += mark ? '.' : *at_;
  }
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.size() > kDigits || error != std::errc() || !std::isfinite(value))
    fail("the number of " + std::string(what) + " is out of range");
  return value;
}

std::string HeidenhainCursor::quoted() {
  if (peek() != '"') fail_unexpected();
  std::string out;
  for (++at_; at_ != end_ && *at_ != '"' && *at_ != '\n'; ++at_) out += *at_;
  if (at_ == end_ || *at_ != '"') fail("a name without its closing quote");
  ++at_;
  return out;
}

void HeidenhainCursor::fail_unexpected() {
  peek();
  std::string shown;
  for (const char* p = at_; p != end_ && !is_blank(*p) && shown.size() < 16; ++p)
    shown += *p > ' ' && *p <= '~' ? *p : '?';
  fail(shown.empty() ? "the block ends too early" : "unexpected '" + shown + "'");
}

}  // namespace riffler::nc
