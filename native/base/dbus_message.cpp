#include "base/dbus_message.hpp"

#include <algorithm>

namespace riffler::base {

namespace {

// Codes of the fields of a header.
enum Field : std::uint8_t {
  kPath = 1,
  kInterface = 2,
  kMember = 3,
  kErrorName = 4,
  kReplySerial = 5,
  kDestination = 6,
  kSignature = 8,
};

std::size_t padded(std::size_t at, std::size_t alignment) {
  return (at + alignment - 1) / alignment * alignment;
}

void put_field(DbusWriter& out, Field field, char type, std::string_view text) {
  if (text.empty()) return;
  out.pad(8);
  out.byte(field);
  out.signature({&type, 1});
  type == 'g' ? out.signature(text) : out.string(text);
}

/// Reads the fields of a header into `message`, up to byte `end`.
void take_fields(DbusReader& in, std::size_t end, DbusMessage& message) {
  while (!in.failed() && in.at() < end) {
    in.pad(8);
    const std::uint8_t code = in.byte();
    const std::string type = in.signature();
    if (type == "u") {
      const std::uint32_t value = in.u32();
      if (code == kReplySerial) message.reply_to = value;
      continue;
    }
    if (type != "s" && type != "o" && type != "g") return in.pad(0);
    std::string text = type == "g" ? in.signature() : in.string();
    if (code == kPath)
      message.path = std::move(text);
    else if (code == kInterface)
      message.interface = std::move(text);
    else if (code == kMember)
      message.member = std::move(text);
    else if (code == kErrorName)
      message.error = std::move(text);
    else if (code == kSignature)
      message.types = std::move(text);
  }
}

}  // namespace

void DbusWriter::pad(std::size_t alignment) {
  bytes_.resize(padded(bytes_.size(), alignment));
}

void DbusWriter::number(std::uint64_t value, std::size_t size) {
  pad(size);
  for (std::size_t k = 0; k < size; ++k) bytes_.push_back(static_cast<std::uint8_t>(value >> (8 * k)));
}

void DbusWriter::string(std::string_view text) {
  u32(static_cast<std::uint32_t>(text.size()));
  bytes_.insert(bytes_.end(), text.begin(), text.end());
  bytes_.push_back(0);
}

void DbusWriter::signature(std::string_view text) {
  byte(static_cast<std::uint8_t>(text.size()));
  bytes_.insert(bytes_.end(), text.begin(), text.end());
  bytes_.push_back(0);
}

/// Padding of 0 is that of a value which cannot be read.
void DbusReader::pad(std::size_t alignment) {
  if (alignment == 0 || padded(at_, alignment) > bytes_.size()) {
    failed_ = true;
    return;
  }
  at_ = padded(at_, alignment);
}

std::uint64_t DbusReader::number(std::size_t size) {
  pad(size);
  if (failed_ || bytes_.size() - at_ < size) {
    failed_ = true;
    return 0;
  }
  std::uint64_t value = 0;
  for (std::size_t k = 0; k < size; ++k) value |= std::uint64_t{bytes_[at_ + k]} << (8 * k);
  at_ += size;
  return value;
}

std::string DbusReader::text(std::size_t size) {
  if (failed_ || bytes_.size() - at_ <= size || bytes_[at_ + size] != 0) {
    failed_ = true;
    return {};
  }
  std::string out(size, '\0');
  std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(at_), size, out.begin());
  at_ += size + 1;
  return out;
}

std::string DbusReader::string() {
  const std::size_t size = u32();
  return text(size);
}

std::string DbusReader::signature() {
  const std::size_t size = byte();
  return text(size);
}

std::vector<std::uint8_t> encode(const DbusCall& call, std::uint32_t serial) {
  DbusWriter fields;  // their array begins at a multiple of 8, as here
  put_field(fields, kPath, 'o', call.path);
  put_field(fields, kInterface, 's', call.interface);
  put_field(fields, kMember, 's', call.member);
  put_field(fields, kDestination, 's', call.destination);
  put_field(fields, kSignature, 'g', call.types);
  DbusWriter out;
  out.byte('l');
  out.byte(static_cast<std::uint8_t>(DbusMessage::Type::Call));
  out.byte(0);
  out.byte(1);
  out.u32(static_cast<std::uint32_t>(call.body.size()));
  out.u32(serial);
  out.u32(static_cast<std::uint32_t>(fields.bytes().size()));
  std::vector<std::uint8_t> bytes = out.bytes();
  bytes.insert(bytes.end(), fields.bytes().begin(), fields.bytes().end());
  bytes.resize(padded(bytes.size(), 8));
  bytes.insert(bytes.end(), call.body.begin(), call.body.end());
  return bytes;
}

std::optional<std::size_t> dbus_size(std::span<const std::uint8_t> start) {
  DbusReader in(start);
  const std::uint8_t order = in.byte(), type = in.byte();
  in.byte();
  const std::uint8_t version = in.byte();
  const std::size_t body = in.u32();
  in.u32();
  const std::size_t fields = in.u32();
  if (in.failed() || order != 'l' || type < 1 || type > 4 || version != 1) return {};
  if (body > kLongestDbus || fields > kLongestDbus) return {};
  const std::size_t size = padded(kDbusStart + fields, 8) + body;
  if (size > kLongestDbus) return {};
  return size;
}

std::optional<DbusMessage> decode(std::span<const std::uint8_t> bytes) {
  if (dbus_size(bytes.first(std::min(bytes.size(), kDbusStart))) != bytes.size()) return {};
  DbusReader in(bytes);
  DbusMessage out;
  in.byte();
  out.type = static_cast<DbusMessage::Type>(in.byte());
  in.byte(), in.byte();
  const std::size_t body = in.u32();
  out.serial = in.u32();
  const std::size_t fields = in.u32();
  take_fields(in, kDbusStart + fields, out);
  if (in.failed() || in.at() != kDbusStart + fields) return {};
  out.body.assign(bytes.end() - static_cast<std::ptrdiff_t>(body), bytes.end());
  return out;
}

}  // namespace riffler::base
