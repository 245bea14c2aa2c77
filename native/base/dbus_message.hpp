// Messages of D-Bus, the part that a client needs to call methods: strings and numbers.
// The format is that of https://dbus.freedesktop.org/doc/dbus-specification.html, version 1 of the protocol.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace riffler::base {

/// Values in the byte order and alignment of D-Bus, little endian.
class DbusWriter {
 public:
  void byte(std::uint8_t value) { bytes_.push_back(value); }
  void u32(std::uint32_t value) { number(value, 4); }
  void u64(std::uint64_t value) { number(value, 8); }
  void string(std::string_view text);     ///< a string or an object's path
  void signature(std::string_view text);  ///< types, at most 255
  void pad(std::size_t alignment);

  const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  void number(std::uint64_t value, std::size_t size);
  std::vector<std::uint8_t> bytes_;
};

/// Reads values. After a value that does not fit, all later reads fail.
class DbusReader {
 public:
  explicit DbusReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  std::uint8_t byte() { return static_cast<std::uint8_t>(number(1)); }
  std::uint32_t u32() { return static_cast<std::uint32_t>(number(4)); }
  std::uint64_t u64() { return number(8); }
  std::string string();
  std::string signature();
  void pad(std::size_t alignment);

  bool failed() const { return failed_; }
  std::size_t at() const { return at_; }

 private:
  std::uint64_t number(std::size_t size);
  std::string text(std::size_t size);
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool failed_ = false;
};

/// A method call. `types` and `body`: its arguments.
struct DbusCall {
  std::string destination, path, interface, member, types{};
  std::vector<std::uint8_t> body{};
};
/// The bytes of a call; `serial` must not be 0.
std::vector<std::uint8_t> encode(const DbusCall& call, std::uint32_t serial);

/// A message that was received.
struct DbusMessage {
  enum class Type : std::uint8_t { Call = 1, Return = 2, Error = 3, Signal = 4 };
  Type type = Type::Signal;
  std::uint32_t serial = 0, reply_to = 0;  // reply_to: serial of the call that it answers, 0 for none
  std::string path{}, interface{}, member{}, error{}, types{};
  std::vector<std::uint8_t> body{};
};

inline constexpr std::size_t kDbusStart = 16;           ///< bytes from which a message's size is known
inline constexpr std::size_t kLongestDbus = 64 * 1024;  ///< bytes; longer messages are refused
/// Size of the message that begins with these 16 bytes; none if they begin no message that is accepted.
std::optional<std::size_t> dbus_size(std::span<const std::uint8_t> start);
/// The message of these bytes; none if they are not one message exactly.
std::optional<DbusMessage> decode(std::span<const std::uint8_t> bytes);

}  // namespace riffler::base
