#include "verify/packet.hpp"

namespace riffler::verify {

const char* name_of(PacketKind kind) {
  static constexpr const char* names[] = {"the context of slabs", "a slab", "a slab's moves", "a slab's result"};
  return names[static_cast<int>(kind)];
}

PacketWriter::PacketWriter(PacketKind kind) {
  put(static_cast<std::uint32_t>(kind));
}

void PacketWriter::put_raw(const void* items, std::size_t n, std::size_t size) {
  put(static_cast<std::uint64_t>(n));
  const auto* first = static_cast<const std::uint8_t*>(items);
  if (n > 0) bytes_.insert(bytes_.end(), first, first + n * size);
}

std::vector<std::uint8_t> PacketWriter::finish() {
  put(base::checksum(bytes_));
  return std::move(bytes_);
}

PacketReader::PacketReader(std::span<const std::uint8_t> bytes, PacketKind kind) : name_(name_of(kind)) {
  constexpr std::size_t least = 2 * sizeof(std::uint32_t);
  if (bytes.size() < least) throw FormatError(name_, "byte " + std::to_string(bytes.size()), "it ends here");
  bytes_ = bytes.first(bytes.size() - sizeof(std::uint32_t));
  if (base::get<std::uint32_t>(bytes, bytes_.size()) != base::checksum(bytes_))
    throw FormatError(name_, "byte " + std::to_string(bytes_.size()), "the checksum does not match");
  if (get<std::uint32_t>() != static_cast<std::uint32_t>(kind)) fail("a packet of another kind");
}

std::size_t PacketReader::count() {
  const auto n = get<std::uint64_t>();
  if (n / base::kMaxDeflated > bytes_.size()) fail("more than a packet of this length can hold");
  return static_cast<std::size_t>(n);
}

void PacketReader::finish() const {
  if (at_ != bytes_.size()) fail("there is more than there should be");
}

void PacketReader::fail(const std::string& what) const {
  throw FormatError(name_, "byte " + std::to_string(at_), what);
}

std::span<const std::uint8_t> PacketReader::take(std::uint64_t n) {
  if (n > bytes_.size() - at_) fail("it ends too soon");
  const std::span<const std::uint8_t> out = bytes_.subspan(at_, static_cast<std::size_t>(n));
  at_ += out.size();
  return out;
}

}  // namespace riffler::verify
