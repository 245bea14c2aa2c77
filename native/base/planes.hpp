// Columns of numbers as compressed byte planes, the content of .rvol chunks.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace riffler::base {

/// Appends little-endian numbers and columns to a byte vector. Use one per thread; it reuses its buffers.
///
/// Replaces a column by its second differences (small numbers for a smooth surface), zigzag codes them so that small
/// negative numbers have zero high bytes too, and splits them into planes of equal byte significance. Each plane is
/// deflated, or stored if its bytes look like noise, as the low mantissa bytes of a cut surface do: trying to deflate
/// those would take most of the time.
class PlaneWriter {
 public:
  explicit PlaneWriter(std::vector<std::uint8_t>& out);
  PlaneWriter(const PlaneWriter&) = delete;
  PlaneWriter& operator=(const PlaneWriter&) = delete;
  ~PlaneWriter();

  void column(std::span<const std::uint64_t> values);
  void column(std::span<const std::uint32_t> values);
  void column(std::span<const std::uint16_t> values);

 private:
  template <class T>
  void write(std::span<const T> values);
  void plane();
  bool deflate_plane();

  struct Deflater;
  std::vector<std::uint8_t>& out_;
  std::unique_ptr<Deflater> deflater_;
  std::vector<std::uint8_t> plane_;
};

/// Reads what PlaneWriter wrote. Throws FormatError naming file and byte. Allocates no more than the available bytes
/// can fill.
class PlaneReader {
 public:
  /// `start`: offset of `bytes` in the file, for messages.
  PlaneReader(std::span<const std::uint8_t> bytes, std::size_t start, const std::string& name);
  PlaneReader(const PlaneReader&) = delete;
  PlaneReader& operator=(const PlaneReader&) = delete;
  ~PlaneReader();

  /// A column of `n` numbers.
  std::vector<std::uint64_t> column64(std::size_t n);
  std::vector<std::uint32_t> column32(std::size_t n);
  std::vector<std::uint16_t> column16(std::size_t n);
  /// Throws FormatError unless all bytes have been read.
  void finish() const;

 private:
  template <class T>
  std::vector<T> read(std::size_t n);
  void plane(std::size_t n);
  std::span<const std::uint8_t> take(std::size_t n);
  [[noreturn]] void fail(const char* what) const;

  struct Inflater;
  std::span<const std::uint8_t> bytes_;
  std::size_t start_, at_ = 0;
  const std::string& name_;
  std::unique_ptr<Inflater> inflater_;
  std::vector<std::uint8_t> plane_;
};

/// Upper bound on deflate's compression ratio (zlib technical details: "Maximum Compression Factor", 1030.3).
inline constexpr std::size_t kMaxDeflated = 1032;

}  // namespace riffler::base
