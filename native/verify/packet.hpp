// Byte packets between processes: numbers, arrays and compressed columns under one checksum.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "base/bytes.hpp"
#include "base/planes.hpp"
#include "riffler/base/error.hpp"

namespace riffler::verify {

/// Content of a packet; named in the reader's messages.
enum class PacketKind : std::uint32_t { Context, Task, Moves, Result };

/// "the context of a cluster's slabs", …
const char* name_of(PacketKind kind);

/// Numbers are little-endian, as in memory. Both ends run the same version of Riffler, so packets do not describe their
/// own layout.
class PacketWriter {
 public:
  explicit PacketWriter(PacketKind kind);

  template <class T>
  void put(const T& value) {
    base::put(bytes_, value);
  }
  /// An array: its length, then its items.
  template <class T>
  void put_all(std::span<const T> items) {
    static_assert(std::is_trivially_copyable_v<T> && std::has_unique_object_representations_v<T>,
                  "bytes between the items would be anything");
    put_raw(items.data(), items.size(), sizeof(T));
  }
  void put_all(std::span<const double> items) { put_raw(items.data(), items.size(), sizeof(double)); }
  /// Compressed columns whose lengths the reader knows: f(PlaneWriter&) writes them.
  template <class F>
  void columns(const F& f) {
    const std::size_t at = bytes_.size();
    put(std::uint64_t{0});
    {
      base::PlaneWriter planes(bytes_);
      f(planes);
    }
    const std::uint64_t length = bytes_.size() - at - sizeof length;
    std::memcpy(bytes_.data() + at, &length, sizeof length);
  }
  /// The packet with its checksum.
  std::vector<std::uint8_t> finish();

 private:
  void put_raw(const void* items, std::size_t n, std::size_t size);
  Bytes bytes_;
};

/// Reads what PacketWriter wrote, in the same order. Throws FormatError, naming packet and byte, for anything else.
class PacketReader {
 public:
  /// Checks kind and checksum. `bytes` must outlive this object.
  PacketReader(std::span<const std::uint8_t> bytes, PacketKind kind);

  template <class T>
  T get() {
    return base::get<T>(take(sizeof(T)), 0);
  }
  template <class T>
  std::vector<T> get_all() {
    const auto n = get<std::uint64_t>();
    if (n > bytes_.size() / sizeof(T)) fail("an array that is longer than the packet");
    const std::span<const std::uint8_t> from = take(n * sizeof(T));
    std::vector<T> items(n);
    if (n > 0) std::memcpy(items.data(), from.data(), from.size());
    return items;
  }
  /// A count of items that each take some of the packet's bytes, possibly compressed.
  std::size_t count();
  /// f(PlaneReader&) reads what `columns` wrote.
  template <class F>
  void columns(const F& f) {
    const auto length = get<std::uint64_t>();
    const std::size_t start = at_ + sizeof length;
    base::PlaneReader planes(take(length), start, name_);
    f(planes);
    planes.finish();
  }
  /// Throws FormatError unless everything was read.
  void finish() const;
  [[noreturn]] void fail(const std::string& what) const;

 private:
  std::span<const std::uint8_t> take(std::uint64_t n);
  std::string name_;
  std::span<const std::uint8_t> bytes_;  // without the checksum
  std::size_t at_ = 0;
};

}  // namespace riffler::verify
