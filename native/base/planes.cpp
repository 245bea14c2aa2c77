#include "base/planes.hpp"

#include <zlib.h>

#include <array>
#include <cstring>
#include <new>
#include <stdexcept>
#include <type_traits>

#include "base/functions.hpp"
#include "riffler/base/error.hpp"

namespace riffler::base {

namespace {

enum Method : std::uint8_t { kStored = 0, kDeflated = 1 };

/// Zigzag: 0, −1, 1, −2, … → 0, 1, 2, 3, …
template <class T>
T zigzag(T d) {
  const T negative = static_cast<T>(d >> (8 * sizeof(T) - 1));
  return static_cast<T>(static_cast<T>(d << 1) ^ static_cast<T>(T{0} - negative));
}

template <class T>
T unzigzag(T z) {
  return static_cast<T>(static_cast<T>(z >> 1) ^ static_cast<T>(T{0} - static_cast<T>(z & 1)));
}

/// Whether deflate would save less than a few per cent: hardly any byte repeats its neighbour and the histogram is
/// flat.
bool looks_like_noise(std::span<const std::uint8_t> bytes) {
  std::array<std::uint32_t, 256> count{};
  std::size_t repeats = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    ++count[bytes[i]];
    repeats += i > 0 && bytes[i] == bytes[i - 1];
  }
  const double n = static_cast<double>(bytes.size());
  if (static_cast<double>(repeats) > 0.03 * n) return false;
  double bits = 0;  // order-0 entropy of all bytes together
  for (const std::uint32_t c : count)
    if (c > 0) bits += c * base::log2(n / c);
  return bits > 7.6 * n;
}

}  // namespace

struct PlaneWriter::Deflater {
  z_stream stream{};
  std::vector<std::uint8_t> buffer;

  // Planes consist of runs; searching for longer matches takes twice the time and saves a few per cent.
  Deflater() {
    if (deflateInit2(&stream, 1, Z_DEFLATED, -MAX_WBITS, 8, Z_RLE) != Z_OK) throw std::bad_alloc();
  }
  ~Deflater() { deflateEnd(&stream); }
};

PlaneWriter::PlaneWriter(std::vector<std::uint8_t>& out) : out_(out), deflater_(std::make_unique<Deflater>()) {}
PlaneWriter::~PlaneWriter() = default;

template <class T>
void PlaneWriter::write(std::span<const T> values) {
  std::vector<T> coded(values.size());
  T last{}, step{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const T difference = static_cast<T>(values[i] - last);
    coded[i] = zigzag(static_cast<T>(difference - step));
    last = values[i], step = difference;
  }
  plane_.resize(values.size());
  for (std::size_t p = 0; p < sizeof(T); ++p) {
    for (std::size_t i = 0; i < coded.size(); ++i) plane_[i] = static_cast<std::uint8_t>(coded[i] >> (8 * p));
    plane();
  }
}

void PlaneWriter::column(std::span<const std::uint64_t> values) {
  write(values);
}
void PlaneWriter::column(std::span<const std::uint32_t> values) {
  write(values);
}
void PlaneWriter::column(std::span<const std::uint16_t> values) {
  write(values);
}

void PlaneWriter::plane() {
  if (plane_.empty()) return;
  if (!looks_like_noise(plane_) && deflate_plane()) return;
  out_.push_back(kStored);
  out_.insert(out_.end(), plane_.begin(), plane_.end());
}

/// Writes method, size in four bytes and raw deflate data. If that is not shorter, writes nothing and returns false.
bool PlaneWriter::deflate_plane() {
  z_stream& stream = deflater_->stream;
  std::vector<std::uint8_t>& buffer = deflater_->buffer;
  buffer.resize(plane_.size());
  deflateReset(&stream);
  stream.next_in = plane_.data(), stream.avail_in = static_cast<uInt>(plane_.size());
  stream.next_out = buffer.data(), stream.avail_out = static_cast<uInt>(buffer.size());
  if (deflate(&stream, Z_FINISH) != Z_STREAM_END) return false;
  const auto size = static_cast<std::uint32_t>(stream.total_out);
  if (size + sizeof size >= plane_.size()) return false;
  std::uint8_t head[1 + sizeof size] = {kDeflated};
  std::memcpy(head + 1, &size, sizeof size);
  out_.insert(out_.end(), head, head + sizeof head);
  out_.insert(out_.end(), buffer.begin(), buffer.begin() + size);
  return true;
}

struct PlaneReader::Inflater {
  z_stream stream{};

  Inflater() {
    if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) throw std::bad_alloc();
  }
  ~Inflater() { inflateEnd(&stream); }
};

PlaneReader::PlaneReader(std::span<const std::uint8_t> bytes, std::size_t start, const std::string& name)
    : bytes_(bytes), start_(start), name_(name), inflater_(std::make_unique<Inflater>()) {}
PlaneReader::~PlaneReader() = default;

void PlaneReader::fail(const char* what) const {
  throw FormatError(name_, "byte " + std::to_string(start_ + at_), what);
}

std::span<const std::uint8_t> PlaneReader::take(std::size_t n) {
  if (n > bytes_.size() - at_) fail("the chunk ends within a plane");
  const auto taken = bytes_.subspan(at_, n);
  at_ += n;
  return taken;
}

void PlaneReader::plane(std::size_t n) {
  const std::uint8_t method = take(1)[0];
  if (method == kStored) {
    const auto stored = take(n);
    plane_.assign(stored.begin(), stored.end());
    return;
  }
  if (method != kDeflated) fail("a plane is neither stored nor deflated");
  std::uint32_t size = 0;
  std::memcpy(&size, take(sizeof size).data(), sizeof size);
  const auto deflated = take(size);
  if (n / kMaxDeflated > deflated.size()) fail("a plane is too short for its count");
  plane_.resize(n);
  z_stream& stream = inflater_->stream;
  inflateReset(&stream);
  stream.next_in = const_cast<Bytef*>(deflated.data());  // zlib only reads it; its old signature lacks the const
  stream.avail_in = static_cast<uInt>(deflated.size());
  stream.next_out = plane_.data(), stream.avail_out = static_cast<uInt>(n);
  if (inflate(&stream, Z_FINISH) != Z_STREAM_END || stream.avail_in != 0 || stream.avail_out != 0)
    fail("a plane's deflate data is broken or has the wrong length");
}

template <class T>
std::vector<T> PlaneReader::read(std::size_t n) {
  std::vector<T> values;
  if (n == 0) return values;
  for (std::size_t p = 0; p < sizeof(T); ++p) {
    plane(n);
    if (p == 0) values.resize(n);  // the available bytes filled one plane, so the column's size is plausible
    for (std::size_t i = 0; i < n; ++i) values[i] = static_cast<T>(values[i] | static_cast<T>(T{plane_[i]} << (8 * p)));
  }
  T last{}, step{};
  for (T& value : values) {
    step = static_cast<T>(step + unzigzag(value));
    last = value = static_cast<T>(last + step);
  }
  return values;
}

std::vector<std::uint64_t> PlaneReader::column64(std::size_t n) {
  return read<std::uint64_t>(n);
}
std::vector<std::uint32_t> PlaneReader::column32(std::size_t n) {
  return read<std::uint32_t>(n);
}
std::vector<std::uint16_t> PlaneReader::column16(std::size_t n) {
  return read<std::uint16_t>(n);
}

void PlaneReader::finish() const {
  if (at_ != bytes_.size()) fail("the chunk has bytes after its last plane");
}

}  // namespace riffler::base
