#include "pen/service/http.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <stdexcept>

#include "pen/link/deadline.hpp"
#include "riffler/pen/hid/open_error.hpp"

namespace riffler::pen {
namespace {

constexpr std::string_view kLineEnd = "\r\n", kHeadEnd = "\r\n\r\n";

bool is_token(std::string_view text) {
  constexpr std::string_view kMarks = "!#$%&'*+-.^_`|~";
  const auto good = [&](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || kMarks.find(c) != kMarks.npos;
  };
  return !text.empty() && std::all_of(text.begin(), text.end(), good);
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

int status_of(std::string_view line) {
  const bool form = line.size() >= 12 && (line.starts_with("HTTP/1.1 ") || line.starts_with("HTTP/1.0 ")) &&
                    (line.size() == 12 || line[12] == ' ');
  int status = 0;
  if (!form || std::from_chars(line.data() + 9, line.data() + 12, status).ptr != line.data() + 12 || status < 100)
    throw std::invalid_argument("the status line is not that of HTTP/1.1");
  return status;
}

/// The size that the head declares; none: until the connection ends.
std::optional<std::size_t> body_size(const HttpHead& head) {
  const std::string_view text = head.field("content-length");
  if (text.empty()) return std::nullopt;
  std::size_t size = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), size);
  if (error != std::errc() || end != text.data() + text.size() || size > kLongestBody)
    throw OpenError(OpenProblem::BadContent, "the length of its answer makes no sense");
  return size;
}

}  // namespace

std::string_view HttpHead::field(std::string_view name) const {
  const auto named = [&](const auto& f) { return f.first == name; };
  const auto at = std::find_if(fields.begin(), fields.end(), named);
  if (at == fields.end() || std::any_of(at + 1, fields.end(), named)) return {};
  return at->second;
}

HttpHead parse_http_head(std::string_view text) {
  HttpHead out;
  const auto line = [&] {
    const std::size_t end = text.find(kLineEnd);
    if (end == text.npos) throw std::invalid_argument("a line does not end");
    const std::string_view found = text.substr(0, end);
    text.remove_prefix(end + kLineEnd.size());
    return found;
  };
  out.status = status_of(line());
  for (std::string_view field = line(); !field.empty(); field = line()) {
    const std::size_t colon = field.find(':');
    if (colon == field.npos || !is_token(field.substr(0, colon))) throw std::invalid_argument("a field has no name");
    std::string name(field.substr(0, colon));
    for (char& c : name)
      if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    out.fields.emplace_back(std::move(name), trimmed(field.substr(colon + 1)));
  }
  if (!text.empty()) throw std::invalid_argument("text follows the empty line");
  return out;
}

HttpHead read_http_head(LoopbackSocket& socket, double seconds, std::string& rest) {
  const Deadline deadline(seconds);
  std::string text;
  std::size_t end = text.npos;
  while ((end = text.find(kHeadEnd)) == text.npos) {
    if (text.size() > kLongestHead) throw OpenError(OpenProblem::BadContent, "its answer is not an HTTP head");
    std::array<std::uint8_t, 1024> bytes{};
    const int n = socket.read(bytes, deadline.left());
    if (n < 0) throw OpenError(OpenProblem::NoAnswer, "it closes the connection");
    if (n == 0) throw OpenError(OpenProblem::NoAnswer, "it does not answer");
    text.append(reinterpret_cast<const char*>(bytes.data()), static_cast<std::size_t>(n));
  }
  end += kHeadEnd.size();
  rest = text.substr(end);
  try {
    return parse_http_head(std::string_view(text).substr(0, end));
  } catch (const std::invalid_argument& error) {
    throw OpenError(OpenProblem::BadContent, std::string("its answer is not HTTP: ") + error.what());
  }
}

std::string http_get(std::uint16_t port, const std::string& path, double seconds) {
  const Deadline deadline(seconds);
  LoopbackSocket socket(port, seconds);
  // Version 1.0: the body is then sent as one piece.
  const std::string request = "GET " + path + " HTTP/1.0\r\nHost: localhost:" + std::to_string(port) +
                              "\r\nAccept: application/json\r\nConnection: close\r\n\r\n";
  if (!socket.write({reinterpret_cast<const std::uint8_t*>(request.data()), request.size()}, deadline.left()))
    throw OpenError(OpenProblem::NoAnswer, "it does not take the request");
  std::string body;
  const HttpHead head = read_http_head(socket, deadline.left(), body);
  if (head.status != 200)
    throw OpenError(OpenProblem::BadContent, "it answers " + path + " with status " + std::to_string(head.status));
  const std::optional<std::size_t> size = body_size(head);
  while (!size || body.size() < *size) {
    if (body.size() > kLongestBody) throw OpenError(OpenProblem::BadContent, "its answer is too long");
    std::array<std::uint8_t, 1024> bytes{};
    const int n = socket.read(bytes, deadline.left());
    if (n < 0 && !size) break;
    if (n <= 0) throw OpenError(OpenProblem::NoAnswer, "its answer is incomplete");
    body.append(reinterpret_cast<const char*>(bytes.data()), static_cast<std::size_t>(n));
  }
  if (size) body.resize(*size);
  return body;
}

}  // namespace riffler::pen
