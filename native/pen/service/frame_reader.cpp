#include "pen/service/frame_reader.hpp"

#include <algorithm>
#include <cstring>

namespace riffler::pen {
namespace {

constexpr std::uint8_t kFinal = 0x80, kReserved = 0x70, kOpcode = 0x0F, kMasked = 0x80, kLength = 0x7F;
constexpr std::size_t kLongestControl = 125;  // bytes of payload of Close, Ping and Pong

bool is_control(Opcode opcode) {
  return (static_cast<unsigned>(opcode) & 8U) != 0;
}

/// Bytes of the length that follows the first two bytes.
std::size_t length_bytes(std::size_t first) {
  return first == 126 ? 2 : first == 127 ? 8 : 0;
}

}  // namespace

FrameReader::FrameReader(std::size_t longest)
    : longest_(longest), buffer_(longest + kLongestFrameHead), message_(longest) {}

std::span<std::uint8_t> FrameReader::space() noexcept {
  if (begin_ > 0) {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_, begin_ = 0;
  }
  return std::span(buffer_).subspan(end_);
}

FrameReader::Event FrameReader::end(Event event) noexcept {
  payload_ = {};
  return ended_ = event;
}

/// Message: the head is complete.
FrameReader::Event FrameReader::read_head(std::span<const std::uint8_t> bytes, Head& head) const noexcept {
  if (bytes.size() < 2) return Event::More;
  head.final = (bytes[0] & kFinal) != 0;
  head.opcode = static_cast<Opcode>(bytes[0] & kOpcode);
  if ((bytes[0] & kReserved) != 0 || (bytes[1] & kMasked) != 0) return Event::Bad;
  const std::size_t first = bytes[1] & kLength, more = length_bytes(first);
  head.head = 2 + more;
  if (bytes.size() < head.head) return Event::More;
  std::uint64_t length = more == 0 ? first : 0;
  for (std::size_t k = 0; k < more; ++k) length = length << 8 | bytes[2 + k];
  // A length has its shortest form, and 63 bits.
  if ((more == 2 && length < 126) || (more == 8 && (length < 65536 || length >> 63 != 0))) return Event::Bad;
  if (length > longest_) return Event::Bad;
  head.payload = static_cast<std::size_t>(length);
  switch (head.opcode) {
    case Opcode::Close:
    case Opcode::Ping:
    case Opcode::Pong:
      return head.final && length <= kLongestControl ? Event::Message : Event::Bad;
    case Opcode::Text:
      return in_message_ ? Event::Bad : Event::Message;
    case Opcode::Continuation:
      return in_message_ ? Event::Message : Event::Bad;
    default:  // binary messages, which no service of ours sends, and reserved kinds
      return Event::Bad;
  }
}

/// More: the message is not complete.
FrameReader::Event FrameReader::data(const Head& head, std::span<const std::uint8_t> bytes) noexcept {
  if (head.opcode == Opcode::Text) size_ = 0;
  if (bytes.size() > longest_ - size_) return end(Event::Bad);
  std::copy(bytes.begin(), bytes.end(), message_.begin() + static_cast<std::ptrdiff_t>(size_));
  size_ += bytes.size();
  in_message_ = !head.final;
  payload_ = std::span(message_).first(size_);
  return head.final ? Event::Message : Event::More;
}

FrameReader::Event FrameReader::next() noexcept {
  while (ended_ == Event::More) {
    const auto bytes = std::span<const std::uint8_t>(buffer_).subspan(begin_, end_ - begin_);
    Head head;
    const Event form = read_head(bytes, head);
    if (form == Event::Bad) return end(Event::Bad);
    if (form == Event::More || bytes.size() < head.head + head.payload) return Event::More;
    begin_ += head.head + head.payload;
    const auto payload = bytes.subspan(head.head, head.payload);
    if (head.opcode == Opcode::Close) return end(Event::Close);
    if (head.opcode == Opcode::Ping) {
      payload_ = payload;
      return Event::Ping;
    }
    if (!is_control(head.opcode))
      if (const Event event = data(head, payload); event != Event::More) return event;
  }
  return ended_;
}

std::size_t write_frame(Opcode opcode, std::span<const std::uint8_t> payload, const std::array<std::uint8_t, 4>& mask,
                        std::span<std::uint8_t> out) noexcept {
  std::size_t at = 0;
  out[at++] = static_cast<std::uint8_t>(kFinal | static_cast<std::uint8_t>(opcode));
  const std::size_t n = payload.size(), first = n < 126 ? n : n < 65536 ? 126 : 127;
  out[at++] = static_cast<std::uint8_t>(kMasked | first);
  for (std::size_t k = length_bytes(first); k-- > 0;)
    out[at++] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(n) >> (8 * k) & 0xFF);
  for (const std::uint8_t m : mask) out[at++] = m;
  for (std::size_t k = 0; k < n; ++k) out[at++] = payload[k] ^ mask[k % 4];
  return at;
}

}  // namespace riffler::pen
