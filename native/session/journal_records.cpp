#include "session/journal_records.hpp"

#include <zlib.h>

#include <bit>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include "geom/error.hpp"

namespace riffler::journal_format {

namespace {

constexpr std::string_view kMagic = "RIFFLERJ", kRecordMagic = "RREC";
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kHeaderSize = 16, kRecordHeaderSize = 16, kRecordTailSize = 4;

enum Kind : std::uint32_t { kStock = 1, kTool = 2, kNote = 3, kStroke = 4, kMore = 5 };

std::uint32_t crc(View bytes) {
  return static_cast<std::uint32_t>(crc32_z(crc32_z(0, nullptr, 0), bytes.data(), bytes.size()));
}

// --- Little-endian numbers and strings ---

template <class T>
void put(Bytes& out, T value) {
  for (std::size_t k = 0; k < sizeof value; ++k) out.push_back(static_cast<std::uint8_t>(value >> (8 * k)));
}

void put(Bytes& out, double value) {
  put(out, std::bit_cast<std::uint64_t>(value));
}

void put_raw(Bytes& out, std::string_view text) {
  for (const char c : text) out.push_back(static_cast<std::uint8_t>(c));
}

void put(Bytes& out, std::string_view text) {
  if (text.size() > 0xFFFFFFFF) throw std::invalid_argument("a text of 4 GB or more");
  put(out, static_cast<std::uint32_t>(text.size()));
  put_raw(out, text);
}

template <class T>
T get(View bytes, std::size_t at) {
  T value = 0;
  for (std::size_t k = 0; k < sizeof value; ++k) value |= static_cast<T>(static_cast<T>(bytes[at + k]) << (8 * k));
  return value;
}

bool starts_with(View bytes, std::string_view text) {
  return bytes.size() >= text.size() && std::memcmp(bytes.data(), text.data(), text.size()) == 0;
}

/// Takes a payload apart.
class Taker {
 public:
  explicit Taker(View bytes) : bytes_(bytes) {}

  View raw(std::uint64_t size) {
    if (size > bytes_.size()) throw std::invalid_argument("a record that is too short for its content");
    const View out = bytes_.first(static_cast<std::size_t>(size));
    bytes_ = bytes_.subspan(static_cast<std::size_t>(size));
    return out;
  }
  std::uint32_t u32() { return get<std::uint32_t>(raw(4), 0); }
  std::uint64_t u64() { return get<std::uint64_t>(raw(8), 0); }
  double f64() { return std::bit_cast<double>(u64()); }
  std::string text() {
    const View view = raw(u32());
    return {view.begin(), view.end()};
  }
  void done() const {
    if (!bytes_.empty()) throw std::invalid_argument("a record that is too long for its content");
  }

 private:
  View bytes_;
};

// --- Poses: columns of doubles to the bit. Neighbours differ little, so the differences of their bit patterns, byte
// plane by byte plane, are mostly zeros, which zlib then packs. ---

constexpr std::size_t kPoseColumns = 6;

double& column(Pose& pose, std::size_t k) {
  return k < 3 ? pose.tip[static_cast<int>(k)] : pose.axis[static_cast<int>(k - 3)];
}

void put_rows(Bytes& out, std::span<const Pose> poses, std::span<const double> times) {
  const std::size_t n = poses.size(), columns = kPoseColumns + (times.empty() ? 0 : 1);
  Bytes planes(n * columns * 8);
  for (std::size_t c = 0; c < columns; ++c) {
    std::uint64_t before = 0;
    for (std::size_t row = 0; row < n; ++row) {
      Pose pose = poses[row];
      const auto bits = std::bit_cast<std::uint64_t>(c < kPoseColumns ? column(pose, c) : times[row]);
      const std::uint64_t difference = bits - before;
      before = bits;
      for (std::size_t k = 0; k < 8; ++k)
        planes[(c * 8 + k) * n + row] = static_cast<std::uint8_t>(difference >> (8 * k));
    }
  }
  uLongf size = compressBound(planes.size());
  Bytes packed(size);
  if (compress2(packed.data(), &size, planes.data(), planes.size(), Z_DEFAULT_COMPRESSION) != Z_OK)
    throw std::runtime_error("zlib cannot compress");
  put(out, static_cast<std::uint64_t>(n));
  put(out, static_cast<std::uint32_t>(columns));
  put(out, static_cast<std::uint64_t>(size));
  out.insert(out.end(), packed.begin(), packed.begin() + static_cast<std::ptrdiff_t>(size));
}

void take_rows(Taker& from, std::vector<Pose>& poses, std::vector<double>& times) {
  const std::uint64_t n = from.u64();
  const std::uint32_t columns = from.u32();
  const View packed = from.raw(from.u64());
  if (columns != kPoseColumns && columns != kPoseColumns + 1)
    throw std::invalid_argument("a stroke with a wrong number of columns");
  // zlib packs at most 1 : 1032, so a damaged count cannot ask for more memory than the file can fill.
  if (n > packed.size() * 1032 / (columns * 8))
    throw std::invalid_argument("a stroke with more poses than it can hold");
  Bytes planes(static_cast<std::size_t>(n * columns * 8));
  uLongf size = planes.size();
  if (uncompress(planes.data(), &size, packed.data(), packed.size()) != Z_OK || size != planes.size())
    throw std::invalid_argument("a stroke that cannot be unpacked");
  poses.resize(static_cast<std::size_t>(n));
  times.resize(columns > kPoseColumns ? poses.size() : 0);
  for (std::size_t c = 0; c < columns; ++c) {
    std::uint64_t bits = 0;
    for (std::size_t row = 0; row < poses.size(); ++row) {
      std::uint64_t difference = 0;
      for (std::size_t k = 0; k < 8; ++k)
        difference |= static_cast<std::uint64_t>(planes[(c * 8 + k) * poses.size() + row]) << (8 * k);
      bits += difference;
      (c < kPoseColumns ? column(poses[row], c) : times[row]) = std::bit_cast<double>(bits);
    }
  }
}

Bytes record(Kind kind, const Bytes& payload) {
  if (payload.size() > 0xFFFFFFFF)
    throw std::invalid_argument("a record of 4 GB or more: extend a stroke piece by piece");
  Bytes out;
  out.reserve(kRecordHeaderSize + payload.size() + kRecordTailSize);
  put_raw(out, kRecordMagic);
  put(out, static_cast<std::uint32_t>(kind));
  put(out, static_cast<std::uint32_t>(payload.size()));
  put(out, crc(out));
  out.insert(out.end(), payload.begin(), payload.end());
  put(out, crc(payload));
  return out;
}

bool record_header_at(View bytes) {
  return bytes.size() >= kRecordHeaderSize && starts_with(bytes, kRecordMagic) &&
         get<std::uint32_t>(bytes, 12) == crc(bytes.first(12));
}

}  // namespace

Bytes journal_header() {
  Bytes out;
  put_raw(out, kMagic);
  put(out, kVersion);
  put(out, crc(out));
  return out;
}

Bytes stock_record(const JournalStock& stock) {
  Bytes out;
  for (const Vec3& corner : {stock.box.lower, stock.box.upper})
    for (int k = 0; k < 3; ++k) put(out, corner[k]);
  put(out, stock.pitch);
  put(out, std::string_view(stock.directions));
  put(out, std::string_view(stock.snapshot));
  return record(kStock, out);
}

Bytes tool_record(int number, const std::string& json) {
  Bytes out;
  put(out, static_cast<std::uint32_t>(number));
  put(out, std::string_view(json));
  return record(kTool, out);
}

Bytes note_record(const std::string& key, const std::string& value) {
  Bytes out;
  put(out, std::string_view(key));
  put(out, std::string_view(value));
  return record(kNote, out);
}

Bytes stroke_record(const JournalStroke& stroke) {
  Bytes out;
  put(out, static_cast<std::uint32_t>(stroke.tool));
  put(out, stroke.tolerance);
  put(out, std::string_view(stroke.name));
  put_rows(out, stroke.poses, stroke.times);
  return record(kStroke, out);
}

Bytes more_record(std::span<const Pose> poses, std::span<const double> times) {
  Bytes out;
  put_rows(out, poses, times);
  return record(kMore, out);
}

std::size_t check_header(View bytes, const std::string& name) {
  const auto fail = [&](std::size_t at, const std::string& what) {
    throw FormatError(name, "byte " + std::to_string(at), what);
  };
  if (!starts_with(bytes, kMagic)) fail(0, "not a journal: it must begin with RIFFLERJ");
  if (bytes.size() < kHeaderSize) fail(bytes.size(), "the header is cut: expected 16 bytes");
  if (get<std::uint32_t>(bytes, 12) != crc(bytes.first(12))) fail(12, "the header is damaged");
  if (const auto version = get<std::uint32_t>(bytes, 8); version != kVersion)
    fail(8, "journal version " + std::to_string(version) + ", expected " + std::to_string(kVersion));
  return kHeaderSize;
}

std::optional<Record> whole_record(View bytes) {
  if (!record_header_at(bytes)) return std::nullopt;
  const std::size_t size = get<std::uint32_t>(bytes, 8), most = bytes.size() - kRecordHeaderSize;
  if (most < kRecordTailSize || most - kRecordTailSize < size) return std::nullopt;
  const View payload = bytes.subspan(kRecordHeaderSize, size);
  if (get<std::uint32_t>(bytes, kRecordHeaderSize + size) != crc(payload)) return std::nullopt;
  return Record{get<std::uint32_t>(bytes, 4), payload, kRecordHeaderSize + size + kRecordTailSize};
}

bool record_follows(View bytes) {
  for (std::size_t at = 1; at + kRecordHeaderSize <= bytes.size(); ++at)
    if (record_header_at(bytes.subspan(at))) return true;
  return false;
}

void apply_record(const Record& record, Journal& journal) {
  Taker from(record.payload);
  switch (record.kind) {
    case kStock: {
      JournalStock stock;
      for (Vec3* corner : {&stock.box.lower, &stock.box.upper})
        for (int k = 0; k < 3; ++k) (*corner)[k] = from.f64();
      stock.pitch = from.f64();
      stock.directions = from.text();
      stock.snapshot = from.text();
      journal.set_stock(std::move(stock));
      break;
    }
    case kTool: {
      const std::uint32_t number = from.u32();
      journal.add_tool(static_cast<int>(number), from.text());
      break;
    }
    case kNote: {
      std::string key = from.text();
      journal.add_note(std::move(key), from.text());
      break;
    }
    case kStroke: {
      JournalStroke stroke;
      stroke.tool = static_cast<int>(from.u32());
      stroke.tolerance = from.f64();
      stroke.name = from.text();
      take_rows(from, stroke.poses, stroke.times);
      journal.add_stroke(std::move(stroke));
      break;
    }
    case kMore: {
      std::vector<Pose> poses;
      std::vector<double> times;
      take_rows(from, poses, times);
      journal.extend_stroke(poses, times);
      break;
    }
    default:
      throw std::invalid_argument("a record of unknown kind " + std::to_string(record.kind));
  }
  from.done();
}

}  // namespace riffler::journal_format
