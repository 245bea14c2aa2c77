#include "pen/service/web_socket.hpp"

#include <algorithm>
#include <random>
#include <string>
#include <utility>

#include "pen/link/deadline.hpp"
#include "pen/service/http.hpp"
#include "pen/service/sha1.hpp"
#include "riffler/pen/hid/open_error.hpp"

namespace riffler::pen {
namespace {

constexpr double kSendTime = 0.01;  // s
constexpr double kLeaveTime = 0.2;  // s
constexpr std::uint16_t kNormal = 1000, kProtocolError = 1002;
constexpr const char* kGuid = "258EAFA5-E914-47DA-95CA-C5AB0DC85B11";  // RFC 6455, 1.3

std::string random_key() {
  std::random_device random;
  std::array<std::uint8_t, 16> bytes{};
  for (std::uint8_t& b : bytes) b = static_cast<std::uint8_t>(random());
  return base64(bytes);
}

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

/// Whether a comma-separated list contains this word, ignoring case.
bool has_word(std::string_view list, std::string_view word) {
  while (!list.empty()) {
    std::string_view one = list.substr(0, list.find(','));
    list.remove_prefix(std::min(one.size() + 1, list.size()));
    while (!one.empty() && (one.front() == ' ' || one.front() == '\t')) one.remove_prefix(1);
    while (!one.empty() && (one.back() == ' ' || one.back() == '\t')) one.remove_suffix(1);
    if (lower(one) == word) return true;
  }
  return false;
}

/// The checks that RFC 6455, 4.1, requires of a client.
void check_answer(const HttpHead& head, const std::string& key) {
  const auto refuse = [](const std::string& why) { throw OpenError(OpenProblem::BadContent, why); };
  if (head.status != 101) refuse("it opens no WebSocket: status " + std::to_string(head.status));
  if (lower(head.field("upgrade")) != "websocket" || !has_word(head.field("connection"), "upgrade"))
    refuse("it upgrades the connection to something other than a WebSocket");
  if (head.field("sec-websocket-accept") != base64(sha1(key + kGuid))) refuse("it answers with a wrong key");
  for (const auto& [name, value] : head.fields)
    if (name == "sec-websocket-extensions" || name == "sec-websocket-protocol")
      refuse("it uses " + name + ", which was not asked for");
}

}  // namespace

WebSocket::WebSocket(std::uint16_t port, double seconds)
    : socket_(port, seconds),
      reader_(kLongestMessage),
      out_(kLongestMessage + kLongestFrameHead),
      mask_(std::uint64_t{std::random_device{}()} << 32 | std::random_device{}() | 1U) {
  handshake(port, seconds);
  open_ = true;
}

WebSocket::~WebSocket() {
  if (!open_) return;
  close(kNormal);
  // The last message may be the one that ends the force.
  socket_.finish(kLeaveTime);
}

void WebSocket::handshake(std::uint16_t port, double seconds) {
  const std::string key = random_key();
  const std::string request = "GET / HTTP/1.1\r\nHost: localhost:" + std::to_string(port) +
                              "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Key: " + key +
                              "\r\nSec-WebSocket-Version: 13\r\n\r\n";
  if (!socket_.write({reinterpret_cast<const std::uint8_t*>(request.data()), request.size()}, seconds))
    throw OpenError(OpenProblem::NoAnswer, "it does not take the request");
  std::string rest;
  check_answer(read_http_head(socket_, seconds, rest), key);
  // The first frames may follow the head at once; they fit, as read_http_head reads less at a time than the reader
  // holds.
  const auto space = reader_.space();
  std::copy(rest.begin(), rest.end(), space.begin());
  reader_.received(rest.size());
}

/// xorshift64.
std::array<std::uint8_t, 4> WebSocket::next_mask() noexcept {
  mask_ ^= mask_ << 13, mask_ ^= mask_ >> 7, mask_ ^= mask_ << 17;
  std::array<std::uint8_t, 4> out{};
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = static_cast<std::uint8_t>(mask_ >> (8 * k + 16) & 0xFF);
  return out;
}

bool WebSocket::send(Opcode opcode, std::span<const std::uint8_t> payload) noexcept {
  if (!open_ || payload.size() > kLongestMessage) return false;
  const std::size_t size = write_frame(opcode, payload, next_mask(), out_);
  // After a partly sent frame nothing else can be sent.
  open_ = socket_.write(std::span(out_).first(size), kSendTime);
  return open_;
}

void WebSocket::close(std::uint16_t code) noexcept {
  const std::array<std::uint8_t, 2> payload{static_cast<std::uint8_t>(code >> 8),
                                            static_cast<std::uint8_t>(code & 0xFF)};
  send(Opcode::Close, payload);
  open_ = false;
}

int WebSocket::read(std::span<std::uint8_t> bytes, double seconds) noexcept {
  const Deadline deadline(seconds);
  for (bool waited = false; open_;) {
    switch (reader_.next()) {
      case FrameReader::Event::Message: {
        const auto message = reader_.payload();
        if (message.size() > bytes.size()) return close(kProtocolError), -1;
        if (message.empty()) break;  // an empty message has no content
        std::copy(message.begin(), message.end(), bytes.begin());
        return static_cast<int>(message.size());
      }
      case FrameReader::Event::Ping:
        if (!send(Opcode::Pong, reader_.payload())) return -1;
        break;
      case FrameReader::Event::Close:
        return close(kNormal), -1;
      case FrameReader::Event::Bad:
        return close(kProtocolError), -1;
      case FrameReader::Event::More: {
        const double left = deadline.left();
        if (std::exchange(waited, true) && left <= 0) return 0;
        const int n = socket_.read(reader_.space(), left);
        if (n < 0) open_ = false;
        if (n > 0) reader_.received(static_cast<std::size_t>(n));
      }
    }
  }
  return -1;
}

bool WebSocket::write(std::span<const std::uint8_t> bytes) noexcept {
  return send(Opcode::Text, bytes);
}

}  // namespace riffler::pen
