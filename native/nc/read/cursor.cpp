#include "nc/read/cursor.hpp"

#include <array>
#include <charconv>
#include <cstdint>
#include <cstdio>

namespace riffler::nc {

char NcCursor::skip_comment() {
  if (*at_ == ';') {
    at_ = end_;
    return '\0';
  }
  // With nested brackets, the remainder that a control sees after the first closing bracket is treated as a comment
  // too.
  int depth = 0;
  for (; at_ != end_; ++at_) {
    depth += *at_ == '(' ? 1 : *at_ == ')' ? -1 : 0;
    if (depth == 0) {
      ++at_;
      return peek();
    }
  }
  fail("unclosed comment");
}

void NcCursor::fail_character() const {
  const char c = *at_;
  std::string shown = std::string("'") + c + "'";
  if (c <= ' ' || c > '~') {
    std::array<char, 16> text{};
    std::snprintf(text.data(), text.size(), "byte 0x%02X", static_cast<unsigned>(static_cast<unsigned char>(c)));
    shown = text.data();
  }
  if (static_cast<unsigned char>(c) >= 0x80) fail("a character outside ASCII (" + shown + ")");
  fail("unexpected " + shown);
}

bool NcCursor::take_word(std::string_view word) {
  peek();
  const char* p = at_;
  for (const char c : word)
    if (p == end_ || upper(*p++) != c) return false;
  at_ = p;
  return true;
}

std::string NcCursor::letters() {
  std::string out;
  for (peek(); at_ != end_ && is_letter(*at_); ++at_) out += upper(*at_);
  return out;
}

bool NcCursor::at_number() {
  peek();
  const char* p = at_;
  if (p != end_ && (*p == '-' || *p == '+')) ++p;
  return p != end_ && (is_digit(*p) || *p == '.');
}

double NcCursor::number(char what) {
  peek();
  bool negative = false;
  if (at_ != end_ && (*at_ == '+' || *at_ == '-')) negative = *at_++ == '-';
  const char* const begin = at_;
  // Up to 15 digits form an integer exact in a double, and so is the power of ten: one division rounds correctly
  // (Clinger, How to Read Floating Point Numbers Accurately, 1990). Other numbers use the library.
  std::uint64_t digits = 0;
  int count = 0, decimals = 0;
  for (; at_ != end_ && is_digit(*at_); ++at_, ++count) digits = digits * 10 + static_cast<std::uint64_t>(*at_ - '0');
  if (at_ != end_ && *at_ == '.')
    for (++at_; at_ != end_ && is_digit(*at_); ++at_, ++decimals)
      digits = digits * 10 + static_cast<std::uint64_t>(*at_ - '0');
  if (count + decimals == 0) {
    at_ = begin;
    fail(std::string("expected a number after ") + what);
  }
  double value;
  if (count + decimals <= 15) {
    constexpr std::array<double, 16> kTens{1e0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                           1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};
    value = static_cast<double>(digits) / kTens[static_cast<std::size_t>(decimals)];
  } else {
    const auto [end, error] = std::from_chars(begin, at_, value, std::chars_format::fixed);
    // Too many leading or trailing zeros may also count as out of range; no sensible program has 300 digits.
    if (error != std::errc() || end != at_) fail(std::string("the number after ") + what + " is out of range");
  }
  return negative ? -value : value;
}

std::string NcCursor::name() {
  std::string out;
  for (; at_ != end_; ++at_) {
    if (*at_ == '>') {
      ++at_;
      if (out.empty()) fail("a name without letters: <>");
      return out;
    }
    if (static_cast<unsigned char>(*at_) >= 0x80 || *at_ == '(' || *at_ == '\0') fail_character();
    if (*at_ != ' ' && *at_ != '\t') out += lower(*at_);
  }
  fail("a name that is not closed by >");
}

}  // namespace riffler::nc
