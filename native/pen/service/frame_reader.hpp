// The frames of a WebSocket (RFC 6455, 5): those of a server are decoded, those of a client are written.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace riffler::pen {

/// Kinds of frames (RFC 6455, 11.8).
enum class Opcode : std::uint8_t { Continuation = 0, Text = 1, Binary = 2, Close = 8, Ping = 9, Pong = 10 };

/// Decodes a server's frames, in pieces of any size. Allocates only when made.
class FrameReader {
 public:
  /// `longest`: bytes of the longest message, all fragments together.
  explicit FrameReader(std::size_t longest);

  /// Space for the next bytes; never empty after next() has returned More.
  std::span<std::uint8_t> space() noexcept;
  /// Declares the first `n` bytes of space() as received.
  void received(std::size_t n) noexcept { end_ += n; }

  enum class Event : unsigned char {
    More,     // no whole frame: more bytes are needed
    Message,  // a text message: payload()
    Ping,     // to be answered with a pong that has payload()
    Close,    // the server closes the connection
    Bad,      // no frame that a server may send, or a message that is too long
  };
  /// The next event. After Close and Bad it stays the same.
  Event next() noexcept;
  /// The message, or the payload of the ping; until the next call of next().
  std::span<const std::uint8_t> payload() const noexcept { return payload_; }

 private:
  struct Head {
    bool final = false;
    Opcode opcode{};
    std::size_t head = 0, payload = 0;  // bytes
  };
  Event read_head(std::span<const std::uint8_t> bytes, Head& head) const noexcept;
  Event data(const Head& head, std::span<const std::uint8_t> bytes) noexcept;
  Event end(Event event) noexcept;

  std::size_t longest_;
  std::vector<std::uint8_t> buffer_;  // received: from begin_ to end_
  std::size_t begin_ = 0, end_ = 0;
  std::vector<std::uint8_t> message_;  // its first size_ bytes
  std::size_t size_ = 0;
  bool in_message_ = false;
  Event ended_ = Event::More;
  std::span<const std::uint8_t> payload_;
};

/// Longest head of a client's frame in bytes: with a length of 64 bits, and the mask.
inline constexpr std::size_t kLongestFrameHead = 14;

/// Writes a whole masked frame to `out`, which holds kLongestFrameHead bytes more than the payload, and returns its
/// size.
std::size_t write_frame(Opcode opcode, std::span<const std::uint8_t> payload, const std::array<std::uint8_t, 4>& mask,
                        std::span<std::uint8_t> out) noexcept;

}  // namespace riffler::pen
