// Little-endian numbers and texts in byte vectors, for the binary file formats.
#pragma once

#include <zlib.h>

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace riffler::base {

static_assert(std::endian::native == std::endian::little, "numbers are copied as they stand in memory");

using Bytes = std::vector<std::uint8_t>;
using ByteView = std::span<const std::uint8_t>;

/// CRC-32 of `a` followed by `b`.
inline std::uint32_t checksum(ByteView a, ByteView b = {}) {
  uLong crc = 0;
  for (const auto part : {a, b})
    if (!part.empty()) crc = crc32_z(crc, part.data(), part.size());  // a null pointer would reset the checksum
  return static_cast<std::uint32_t>(crc);
}

template <class T>
  requires std::is_arithmetic_v<T>
void put(Bytes& out, const T& value) {
  const std::size_t at = out.size();
  out.resize(at + sizeof value);
  std::memcpy(out.data() + at, &value, sizeof value);
}

template <class T, std::size_t N>
void put(Bytes& out, const std::array<T, N>& values) {
  for (const T& value : values) put(out, value);
}

inline void put_raw(Bytes& out, std::string_view text) {
  for (const char c : text) out.push_back(static_cast<std::uint8_t>(c));
}

/// Appends the text's length as u32, then the text.
inline void put_text(Bytes& out, std::string_view text) {
  if (text.size() > 0xFFFFFFFF) throw std::invalid_argument("a text of 4 GB or more");
  put(out, static_cast<std::uint32_t>(text.size()));
  put_raw(out, text);
}

template <class T>
T get(ByteView bytes, std::size_t at) {
  static_assert(std::is_trivially_copyable_v<T>);
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// Parses a record. Throws std::invalid_argument if the record is shorter or longer than its content.
class ByteReader {
 public:
  explicit ByteReader(ByteView bytes) : bytes_(bytes) {}

  ByteView raw(std::uint64_t size) {
    if (size > bytes_.size()) throw std::invalid_argument("a record that is too short for its content");
    const ByteView out = bytes_.first(static_cast<std::size_t>(size));
    bytes_ = bytes_.subspan(static_cast<std::size_t>(size));
    return out;
  }
  template <class T>
  T number() {
    return get<T>(raw(sizeof(T)), 0);
  }
  std::string text() {
    const ByteView view = raw(number<std::uint32_t>());
    return {view.begin(), view.end()};
  }
  void done() const {
    if (!bytes_.empty()) throw std::invalid_argument("a record that is too long for its content");
  }

 private:
  ByteView bytes_;
};

}  // namespace riffler::base

namespace riffler {
using base::Bytes;
using base::ByteView;
}  // namespace riffler
