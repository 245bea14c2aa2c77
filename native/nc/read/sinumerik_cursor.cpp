#include "nc/read/sinumerik_cursor.hpp"

#include <charconv>
#include <cmath>
#include <system_error>

#include "base/functions.hpp"

namespace riffler::nc {

char SinumerikCursor::peek() {
  const std::size_t first = rest_.find_first_not_of(" \t\r");
  if (first == rest_.npos || rest_[first] == ';') {
    rest_ = {};
    return '\0';
  }
  rest_.remove_prefix(first);
  return rest_[0] == '\0' ? '?' : NcCursor::upper(rest_[0]);
}

bool SinumerikCursor::take_if(std::string_view symbol) {
  peek();
  if (!rest_.starts_with(symbol)) return false;
  rest_.remove_prefix(symbol.size());
  return true;
}

bool SinumerikCursor::take_word(std::string_view word) {
  SinumerikCursor ahead = *this;
  if (ahead.name() != word) return false;
  rest_ = ahead.rest_;
  return true;
}

bool SinumerikCursor::at_address() {
  if (!NcCursor::is_letter(peek())) return false;
  return rest_.size() < 2 || !is_of_name(rest_[1]) || NcCursor::is_digit(rest_[1]);
}

bool SinumerikCursor::at_number() {
  const char c = peek();
  return NcCursor::is_digit(c) || (c == '.' && rest_.size() > 1 && NcCursor::is_digit(rest_[1]));
}

std::string SinumerikCursor::name() {
  std::string out;
  peek();
  if (rest_.empty() || !is_of_name(rest_[0]) || NcCursor::is_digit(rest_[0])) return out;
  std::size_t k = 0;
  for (; k < rest_.size() && is_of_name(rest_[k]); ++k) out += NcCursor::upper(rest_[k]);
  rest_.remove_prefix(k);
  return out;
}

double SinumerikCursor::number(std::string_view what) {
  if (!at_number()) fail(std::string(what) + " without a number");
  const auto read = [&](int& value) {
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    return error == std::errc();
  };
  double value = 0;
  const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value, std::chars_format::fixed);
  bool good = error == std::errc();
  rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
  if (rest_.size() > 2 && NcCursor::upper(rest_[0]) == 'E' && NcCursor::upper(rest_[1]) == 'X') {
    rest_.remove_prefix(2);
    if (rest_[0] == '+') rest_.remove_prefix(1);
    int exponent = 0;
    good = read(exponent) && good;
    value *= base::pow(10.0, exponent);
  }
  if (!good || !std::isfinite(value)) fail(std::string("the number of ") + std::string(what) + " is out of range");
  return value;
}

std::string SinumerikCursor::digits() {
  std::size_t k = 0;
  while (k < rest_.size() && NcCursor::is_digit(rest_[k])) ++k;
  const std::string out(rest_.substr(0, k));
  rest_.remove_prefix(k);
  return out;
}

std::string SinumerikCursor::quoted() {
  const std::size_t end = peek() == '"' ? rest_.find('"', 1) : rest_.npos;
  if (end == rest_.npos) fail("a text without its closing quote");
  const std::string out(rest_.substr(1, end - 1));
  rest_.remove_prefix(end + 1);
  return out;
}

void SinumerikCursor::skip_brackets() {
  for (int depth = 1; depth > 0;) {
    const char c = peek();
    if (c == '\0') fail("a bracket that is not closed");
    if (c == '"') {
      quoted();
      continue;
    }
    depth += c == '(' || c == '[' ? 1 : c == ')' || c == ']' ? -1 : 0;
    take();
  }
}

void SinumerikCursor::expect_end() {
  if (peek() != '\0') fail_unexpected();
}

void SinumerikCursor::fail_unexpected() {
  if (peek() == '(')
    fail("unexpected '(': a comment begins with ; here; round brackets hold the arguments of known names");
  std::string shown;
  for (const char c : rest_.substr(0, 16)) {
    if (c == ' ' || c == ';') break;
    shown += c > ' ' && c <= '~' ? c : '?';
  }
  fail(shown.empty() ? "the block ends too early" : "unexpected '" + shown + "'");
}

}  // namespace riffler::nc
