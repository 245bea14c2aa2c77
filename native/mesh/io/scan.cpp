#include "mesh/io/scan.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "riffler/base/error.hpp"

namespace riffler::mesh {

namespace {

bool blank(char c) {
  return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}
bool end_of_line(char c) {
  return c == '\n' || c == '\r';
}
char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

}  // namespace

std::optional<double> to_number(std::string_view token) {
  if (token.starts_with('+')) token.remove_prefix(1);
  if (token.starts_with('+')) return {};
  double value = 0;
  const auto [end, code] = std::from_chars(token.data(), token.data() + token.size(), value);
  if (end != token.data() + token.size()) return {};
  if (code == std::errc::result_out_of_range) {
    // A value too small gives 0; one too large is not a number. from_chars does not distinguish them. The exponent's
    // sign does or, without an exponent, whether the number starts with 0.
    const std::size_t e = token.find_first_of("eE");
    const bool small = e != token.npos ? token.substr(e + 1).starts_with('-') : token.find_first_of("123456789") > 1;
    return small ? std::optional(0.0) : std::nullopt;
  }
  if (code != std::errc() || !std::isfinite(value)) return {};
  return value;
}

std::optional<std::int64_t> to_integer(std::string_view token) {
  if (token.starts_with('+')) token.remove_prefix(1);
  if (token.starts_with('+')) return {};
  std::int64_t value = 0;
  const auto [end, code] = std::from_chars(token.data(), token.data() + token.size(), value);
  if (end != token.data() + token.size() || code != std::errc()) return {};
  return value;
}

bool is_not_a_number(std::string_view token) {
  if (token.find('#') != token.npos) return true;
  if (token.starts_with('+') || token.starts_with('-')) token.remove_prefix(1);
  const std::string_view start = token.substr(0, 3);
  return equal_ignoring_case(start, "nan") || equal_ignoring_case(start, "inf");
}

std::string in_quotes(std::string_view token) {
  constexpr std::size_t kLongest = 24;
  std::string text = "'";
  for (const char c : token.substr(0, kLongest)) text += c >= ' ' && c < 127 ? c : '?';
  return text + (token.size() > kLongest ? "…'" : "'");
}

bool equal_ignoring_case(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) { return lower(x) == lower(y); });
}

Scanner::Scanner(std::span<const std::uint8_t> text, std::string name, std::size_t line)
    : text_(reinterpret_cast<const char*>(text.data()), text.size()), name_(std::move(name)), line_(line) {
  if (line == 1 && text_.starts_with("\xef\xbb\xbf")) at_ = 3;
}

std::string_view Scanner::token() {
  for (;;) {
    const std::string_view found = token_in_line();
    if (!found.empty() || at_end()) return found;
    next_line();
  }
}

std::string_view Scanner::token_in_line() {
  while (at_ < text_.size() && blank(text_[at_])) ++at_;
  const std::size_t begin = at_;
  while (at_ < text_.size() && !blank(text_[at_]) && !end_of_line(text_[at_])) ++at_;
  return text_.substr(begin, at_ - begin);
}

void Scanner::next_line() {
  while (at_ < text_.size() && !end_of_line(text_[at_])) ++at_;
  if (at_ == text_.size()) return;
  if (text_[at_] == '\r' && at_ + 1 < text_.size() && text_[at_ + 1] == '\n') ++at_;
  ++at_, ++line_;
}

void Scanner::expect(std::string_view word) {
  const std::string_view found = token();
  if (!equal_ignoring_case(found, word)) fail_expected("'" + std::string(word) + "'", found);
}

double Scanner::number(const char* what) {
  const std::string_view found = token();
  const std::optional<double> value = to_number(found);
  if (!value) fail_expected(what, found);
  return *value;
}

void Scanner::skip_number(const char* what) {
  const std::string_view found = token();
  if (to_number(found) || is_not_a_number(found)) return;
  std::string with_point(found);
  if (const std::size_t comma = with_point.find(','); comma != with_point.npos) with_point[comma] = '.';
  if (!to_number(with_point)) fail_expected(what, found);
}

Vec3 Scanner::vertex() {
  Vec3 v;
  for (int k = 0; k < 3; ++k) {
    v[k] = number("a finite coordinate");
    // The limit also applies after rounding: the float32 next to 1e30 is larger.
    if (!(std::abs(v[k]) <= 1e30 && std::abs(static_cast<double>(static_cast<float>(v[k]))) <= 1e30))
      fail("a vertex's coordinate is beyond 1e30");
  }
  return v;
}

void Scanner::fail(const std::string& what) const {
  throw FormatError(name_, "line " + std::to_string(line_), what);
}

void Scanner::fail_expected(const std::string& expected, std::string_view found) const {
  if (found.empty() && at_end()) fail("the file ends where " + expected + " was expected");
  fail("expected " + expected + ", found " + (found.empty() ? "the end of the line" : in_quotes(found)));
}

}  // namespace riffler::mesh
