// The server's side of a WebSocket (RFC 6455), for tests.
#pragma once

#include <optional>
#include <string>

#include "pen/service/loopback_server.hpp"
#include "pen/service/sha1.hpp"

namespace riffler::test {

/// An unmasked frame. `first`: FIN, reserved bits and opcode.
inline std::string server_frame(const std::string& payload, int first = 0x81) {
  std::string out{static_cast<char>(first)};
  const std::size_t n = payload.size();
  const int more = n < 126 ? 0 : n < 65536 ? 2 : 8;
  out += static_cast<char>(more == 0 ? n : more == 2 ? 126 : 127);
  for (int k = more; k-- > 0;) out += static_cast<char>(n >> (8 * k) & 0xFF);
  return out + payload;
}

inline std::string field_of(const std::string& head, const std::string& name) {
  const std::size_t at = head.find("\r\n" + name + ": ");
  if (at == head.npos) return {};
  const std::size_t from = at + name.size() + 4;
  return head.substr(from, head.find("\r\n", from) - from);
}

/// The answer that opens a WebSocket.
inline std::string upgrade_answer(const std::string& request) {
  const std::string key = field_of(request, "Sec-WebSocket-Key");
  return "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Accept: " +
         pen::base64(pen::sha1(key + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11")) + "\r\n\r\n";
}

/// Decodes a client's frames.
class ClientFrames {
 public:
  struct Frame {
    int opcode;
    bool masked;
    std::string payload;
  };
  void add(const std::string& bytes) { bytes_ += bytes; }
  std::optional<Frame> next() {
    const auto byte = [&](std::size_t k) { return static_cast<unsigned>(static_cast<unsigned char>(bytes_[k])); };
    if (bytes_.size() < 2) return std::nullopt;
    std::size_t size = byte(1) & 127, at = 2;
    const std::size_t more = size == 126 ? 2 : size == 127 ? 8 : 0;
    const bool masked = (byte(1) & 128) != 0;
    if (bytes_.size() < at + more + (masked ? 4 : 0)) return std::nullopt;
    if (more > 0) size = 0;
    for (std::size_t k = 0; k < more; ++k) size = size << 8 | byte(at + k);
    at += more;
    const std::string mask = masked ? bytes_.substr(at, 4) : std::string(4, '\0');
    at += masked ? 4 : 0;
    if (bytes_.size() < at + size) return std::nullopt;
    Frame out{static_cast<int>(byte(0) & 15), masked, bytes_.substr(at, size)};
    for (std::size_t k = 0; k < size; ++k) out.payload[k] = static_cast<char>(out.payload[k] ^ mask[k % 4]);
    bytes_.erase(0, at + size);
    return out;
  }

 private:
  std::string bytes_;
};

}  // namespace riffler::test
