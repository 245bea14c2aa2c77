#include "pen/service/json_reader.hpp"

#include <charconv>
#include <cmath>

namespace riffler::pen {
namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

bool is_hexadecimal(char c) {
  return is_digit(c) || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F');
}

/// Bytes of the number at the front of `text` by JSON's grammar; 0 if there is none.
std::size_t number_size(std::string_view text) {
  std::size_t at = 0;
  const auto digits = [&] {
    const std::size_t from = at;
    while (at < text.size() && is_digit(text[at])) ++at;
    return at > from;
  };
  const auto has = [&](char c) { return at < text.size() && text[at] == c && ++at > 0; };
  has('-');
  if (!has('0') && !digits()) return 0;
  if (has('.') && !digits()) return 0;
  if (has('e') || has('E')) {
    if (!has('+')) has('-');
    if (!digits()) return 0;
  }
  return at;
}

}  // namespace

bool JsonReader::fail() {
  ok_ = false;
  return false;
}

void JsonReader::space() {
  while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\n' || text_[at_] == '\r' || text_[at_] == '\t'))
    ++at_;
}

char JsonReader::peek() {
  space();
  return ok_ && at_ < text_.size() ? text_[at_] : '\0';
}

bool JsonReader::take(char c) {
  if (peek() != c) return fail();
  ++at_;
  return true;
}

bool JsonReader::done() {
  space();
  return ok_ && depth_ == 0 && at_ == text_.size() && !text_.empty();
}

bool JsonReader::object() {
  if (!take('{')) return false;
  if (depth_ == kDeepest) return fail();
  begun_[depth_++] = false;
  return true;
}

bool JsonReader::array() {
  if (!take('[')) return false;
  if (depth_ == kDeepest) return fail();
  begun_[depth_++] = false;
  return true;
}

/// Passes the comma before a member or element, or the end of the container.
bool JsonReader::next(char close) {
  if (!ok_) return false;
  if (depth_ == 0) return fail();
  bool& begun = begun_[depth_ - 1];
  if (peek() == close) {
    ++at_;
    --depth_;
    return false;
  }
  if (begun && !take(',')) return false;
  begun = true;
  return true;
}

bool JsonReader::key(std::string_view& name) {
  return next('}') && string(name) && take(':');
}

bool JsonReader::element() {
  return next(']');
}

bool JsonReader::number(double& value) {
  peek();
  const std::string_view rest = text_.substr(at_);
  const std::size_t size = ok_ ? number_size(rest) : 0;
  if (size == 0) return fail();
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + size, value);
  // A number beyond the range of doubles is one that nothing here means.
  if (error != std::errc() || end != rest.data() + size || !std::isfinite(value)) return fail();
  at_ += size;
  return true;
}

bool JsonReader::word(std::string_view expected) {
  peek();
  if (!ok_ || !text_.substr(at_).starts_with(expected)) return fail();
  at_ += expected.size();
  return true;
}

bool JsonReader::boolean(bool& value) {
  value = peek() == 't';
  return word(value ? "true" : "false");
}

/// What follows a backslash.
bool JsonReader::escape() {
  constexpr std::string_view kShort = "\"\\/bfnrt";
  if (at_ == text_.size()) return fail();
  const char c = text_[at_++];
  if (kShort.find(c) != kShort.npos) return true;
  if (c != 'u' || text_.size() - at_ < 4) return fail();
  for (int k = 0; k < 4; ++k)
    if (!is_hexadecimal(text_[at_++])) return fail();
  return true;
}

bool JsonReader::string(std::string_view& value) {
  if (!take('"')) return false;
  const std::size_t from = at_;
  while (at_ < text_.size()) {
    const char c = text_[at_++];
    if (c == '"') {
      value = text_.substr(from, at_ - 1 - from);
      return true;
    }
    if (static_cast<unsigned char>(c) < 0x20) return fail();
    if (c == '\\' && !escape()) return false;
  }
  return fail();
}

bool JsonReader::skip() {
  std::string_view text;
  double number_value = 0;
  bool truth = false;
  switch (peek()) {
    case '{':
      object();
      while (key(text)) skip();
      return ok_;
    case '[':
      array();
      while (element()) skip();
      return ok_;
    case '"':
      return string(text);
    case 't':
    case 'f':
      return boolean(truth);
    case 'n':
      return word("null");
    default:
      return number(number_value);
  }
}

}  // namespace riffler::pen
