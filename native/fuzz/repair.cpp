#include "fuzz/repair.hpp"

#include <cstring>

#include "base/bytes.hpp"

namespace riffler::fuzz {

namespace {

template <class T>
void set(Bytes& bytes, std::size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

/// Repairs .rvol and .rprog files: a header with the file's length at byte 16 and its own checksum in its last four
/// bytes, then pieces whose head has the payload's length at `length_at` and, in its last four bytes, a checksum of
/// head and payload.
void repair_pieces(Bytes& bytes, std::size_t header, std::size_t head, std::size_t length_at) {
  if (bytes.size() < header) return;
  for (std::size_t at = header; at + head <= bytes.size();) {
    const std::size_t rest = bytes.size() - at - head;
    const auto length = base::get<std::uint64_t>(bytes, at + length_at);
    if (length > rest) set(bytes, at + length_at, static_cast<std::uint64_t>(rest));
    const std::size_t size = length > rest ? rest : static_cast<std::size_t>(length);
    const ByteView all(bytes);
    set(bytes, at + head - 4, base::checksum(all.subspan(at, head - 4), all.subspan(at + head, size)));
    at += head + size;
  }
  set(bytes, 16, static_cast<std::uint64_t>(bytes.size()));
  set(bytes, header - 4, base::checksum(ByteView(bytes).first(header - 4)));
}

}  // namespace

void repair_volume(Bytes& bytes) {
  repair_pieces(bytes, 96, 24, 12);
}

void repair_program(Bytes& bytes) {
  repair_pieces(bytes, 40, 20, 8);
}

void repair_journal(Bytes& bytes) {
  constexpr std::size_t kHeader = 16, kHead = 16, kTail = 4;
  if (bytes.size() < kHeader) return;
  set(bytes, 12, base::checksum(ByteView(bytes).first(12)));
  for (std::size_t at = kHeader; at + kHead + kTail <= bytes.size();) {
    const std::size_t rest = bytes.size() - at - kHead - kTail;
    const auto length = base::get<std::uint32_t>(bytes, at + 8);
    const std::size_t size = length > rest ? rest : length;
    set(bytes, at + 8, static_cast<std::uint32_t>(size));
    const ByteView all(bytes);
    set(bytes, at + 12, base::checksum(all.subspan(at, 12)));
    set(bytes, at + kHead + size, base::checksum(all.subspan(at + kHead, size)));
    at += kHead + size + kTail;
  }
}

void repair_packet(Bytes& bytes) {
  if (bytes.size() < 8) return;
  set(bytes, bytes.size() - 4, base::checksum(ByteView(bytes).first(bytes.size() - 4)));
}

}  // namespace riffler::fuzz
