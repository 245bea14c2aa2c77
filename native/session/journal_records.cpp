#include "session/journal_records.hpp"

#include <zlib.h>

#include <bit>
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "riffler/base/error.hpp"

namespace riffler::session::journal_format {

namespace {

constexpr std::string_view kMagic = "RIFFLERJ", kRecordMagic = "RREC";
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kHeaderSize = 16, kRecordHeaderSize = 16, kRecordTailSize = 4;

enum Kind : std::uint32_t {
  kStock = 1,
  kTool = 2,
  kNote = 3,
  kStroke = 4,
  kMore = 5,
  kTakeBack = 6,
  kBringBack = 7,
  kClayStroke = 8,  // a stroke with its mode
  kMaskedStock = 9  // a stock with the name of its mask
};

bool starts_with(View bytes, std::string_view text) {
  return bytes.size() >= text.size() && std::memcmp(bytes.data(), text.data(), text.size()) == 0;
}

// --- Rows: columns of doubles, exactly. Neighbours differ little, so the differences of their bit patterns, split into
// byte planes, are mostly zeros, which zlib then packs. ---

struct Column {
  enum Of { kTip, kAxis, kForward, kTime, kForce, kTorque, kRemoved } of;
  int k = 0;  // component of a vector
};

/// Which optional columns there are.
struct Optional {
  bool times, forces, removed, forward;
};

/// The columns in file order.
std::vector<Column> columns_of(const Optional& optional) {
  const auto [times, forces, removed, forward] = optional;
  std::vector<Column> out;
  const auto vector = [&](Column::Of of) { out.insert(out.end(), {{of, 0}, {of, 1}, {of, 2}}); };
  vector(Column::kTip), vector(Column::kAxis);
  if (times) out.push_back({Column::kTime});
  if (forces) vector(Column::kForce), vector(Column::kTorque);
  if (removed) out.push_back({Column::kRemoved});
  if (forward) vector(Column::kForward);
  return out;
}

/// `Rows`: JournalRows or a JournalStroke.
template <class Rows>
auto& value(Rows& rows, const Column& column, std::size_t row) {
  switch (column.of) {
    case Column::kTip:
      return rows.poses[row].tip[column.k];
    case Column::kAxis:
      return rows.poses[row].axis[column.k];
    case Column::kForward:
      return rows.forward[row][column.k];
    case Column::kForce:
      return rows.forces[row].force[column.k];
    case Column::kTorque:
      return rows.forces[row].torque[column.k];
    case Column::kRemoved:
      return rows.removed[row];
    case Column::kTime:
      break;
  }
  return rows.times[row];
}

// The set of columns: their number in the low byte, and a bit for each optional column. Times have no bit: the number
// implies them.
constexpr std::uint32_t kForces = 0x100, kRemoved = 0x200, kForward = 0x400;

std::uint32_t code_of(const Optional& optional) {
  return static_cast<std::uint32_t>(columns_of(optional).size()) | (optional.forces ? kForces : 0) |
         (optional.removed ? kRemoved : 0) | (optional.forward ? kForward : 0);
}

void put_rows(Bytes& out, const JournalRows& rows) {
  const Optional optional{!rows.times.empty(), !rows.forces.empty(), !rows.removed.empty(), !rows.forward.empty()};
  const std::vector<Column> columns = columns_of(optional);
  const std::size_t n = rows.poses.size();
  Bytes planes(n * columns.size() * 8);
  for (std::size_t c = 0; c < columns.size(); ++c) {
    std::uint64_t before = 0;
    for (std::size_t row = 0; row < n; ++row) {
      const auto bits = std::bit_cast<std::uint64_t>(value(rows, columns[c], row));
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
  base::put(out, static_cast<std::uint64_t>(n));
  base::put(out, code_of(optional));
  base::put(out, static_cast<std::uint64_t>(size));
  out.insert(out.end(), packed.begin(), packed.begin() + static_cast<std::ptrdiff_t>(size));
}

/// The columns for a code in a file; a reader that does not know all of them must not guess.
std::vector<Column> known_columns(std::uint32_t code) {
  for (const bool times : {false, true}) {
    const Optional optional{times, (code & kForces) != 0, (code & kRemoved) != 0, (code & kForward) != 0};
    if (code == code_of(optional)) return columns_of(optional);
  }
  throw std::invalid_argument("a stroke with a wrong number of columns");
}

/// Fills the rows of an empty stroke.
void take_rows(base::ByteReader& from, JournalStroke& out) {
  const std::uint64_t n = from.number<std::uint64_t>();
  const std::vector<Column> columns = known_columns(from.number<std::uint32_t>());
  const View packed = from.raw(from.number<std::uint64_t>());
  // zlib packs at most 1 : 1032, so a damaged count cannot request more memory than the file can fill.
  if (n > packed.size() * 1032 / (columns.size() * 8))
    throw std::invalid_argument("a stroke with more poses than it can hold");
  const auto rows = static_cast<std::size_t>(n);
  Bytes planes(rows * columns.size() * 8);
  uLongf size = planes.size();
  if (uncompress(planes.data(), &size, packed.data(), packed.size()) != Z_OK || size != planes.size())
    throw std::invalid_argument("a stroke that cannot be unpacked");
  out.poses.resize(rows);
  for (const Column& column : columns) {
    if (column.of == Column::kTime) out.times.resize(rows);
    if (column.of == Column::kForce) out.forces.resize(rows);
    if (column.of == Column::kRemoved) out.removed.resize(rows);
    if (column.of == Column::kForward) out.forward.resize(rows);
  }
  for (std::size_t c = 0; c < columns.size(); ++c) {
    std::uint64_t bits = 0;
    for (std::size_t row = 0; row < rows; ++row) {
      std::uint64_t difference = 0;
      for (std::size_t k = 0; k < 8; ++k)
        difference |= static_cast<std::uint64_t>(planes[(c * 8 + k) * rows + row]) << (8 * k);
      bits += difference;
      value(out, columns[c], row) = std::bit_cast<double>(bits);
    }
  }
}

StrokeMode known_mode(std::uint32_t mode) {
  if (mode >= kStrokeModes)
    throw std::invalid_argument("a stroke of mode " + std::to_string(mode) +
                                ", unknown here: a newer Riffler wrote it");
  return static_cast<StrokeMode>(mode);
}

brush::Falloff known_falloff(std::uint32_t falloff) {
  if (falloff >= brush::kFalloffs)
    throw std::invalid_argument("a brush with falloff " + std::to_string(falloff) +
                                ", unknown here: a newer Riffler wrote it");
  return static_cast<brush::Falloff>(falloff);
}

Bytes record(Kind kind, const Bytes& payload) {
  if (payload.size() > 0xFFFFFFFF)
    throw std::invalid_argument("a record of 4 GB or more: extend a stroke piece by piece");
  Bytes out;
  out.reserve(kRecordHeaderSize + payload.size() + kRecordTailSize);
  base::put_raw(out, kRecordMagic);
  base::put(out, static_cast<std::uint32_t>(kind));
  base::put(out, static_cast<std::uint32_t>(payload.size()));
  base::put(out, base::checksum(out));
  out.insert(out.end(), payload.begin(), payload.end());
  base::put(out, base::checksum(payload));
  return out;
}

bool record_header_at(View bytes) {
  return bytes.size() >= kRecordHeaderSize && starts_with(bytes, kRecordMagic) &&
         base::get<std::uint32_t>(bytes, 12) == base::checksum(bytes.first(12));
}

}  // namespace

Bytes journal_header() {
  Bytes out;
  base::put_raw(out, kMagic);
  base::put(out, kVersion);
  base::put(out, base::checksum(out));
  return out;
}

Bytes stock_record(const JournalStock& stock) {
  Bytes out;
  for (const Vec3& corner : {stock.box.lower, stock.box.upper})
    for (int k = 0; k < 3; ++k) base::put(out, corner[k]);
  base::put(out, stock.pitch);
  base::put_text(out, stock.directions);
  base::put_text(out, stock.snapshot);
  if (stock.mask.empty()) return record(kStock, out);
  base::put_text(out, stock.mask);
  return record(kMaskedStock, out);
}

Bytes tool_record(int number, const std::string& json) {
  Bytes out;
  base::put(out, static_cast<std::uint32_t>(number));
  base::put_text(out, json);
  return record(kTool, out);
}

Bytes note_record(const std::string& key, const std::string& value) {
  Bytes out;
  base::put_text(out, key);
  base::put_text(out, value);
  return record(kNote, out);
}

Bytes stroke_record(const JournalStroke& stroke) {
  // A removing stroke uses the original record kind, which readers without modes understand.
  const bool removes = stroke.mode == StrokeMode::Remove;
  Bytes out;
  base::put(out, static_cast<std::uint32_t>(stroke.tool));
  base::put(out, stroke.tolerance);
  base::put_text(out, stroke.name);
  put_rows(out, stroke.rows());
  if (!removes) base::put(out, static_cast<std::uint32_t>(stroke.mode));
  if (stroke.mode == StrokeMode::Soften || is_brush(stroke.mode)) base::put(out, stroke.strength);
  if (is_brush(stroke.mode)) base::put(out, stroke.amount), base::put(out, static_cast<std::uint32_t>(stroke.falloff));
  return record(removes ? kStroke : kClayStroke, out);
}

Bytes more_record(const JournalRows& rows) {
  Bytes out;
  put_rows(out, rows);
  return record(kMore, out);
}

Bytes undo_record(std::size_t n) {
  Bytes out;
  base::put(out, static_cast<std::uint64_t>(n));
  return record(kTakeBack, out);
}

Bytes redo_record(std::size_t n) {
  Bytes out;
  base::put(out, static_cast<std::uint64_t>(n));
  return record(kBringBack, out);
}

std::size_t check_header(View bytes, const std::string& name) {
  const auto fail = [&](std::size_t at, const std::string& what) {
    throw FormatError(name, "byte " + std::to_string(at), what);
  };
  if (!starts_with(bytes, kMagic)) fail(0, "not a journal: it must begin with RIFFLERJ");
  if (bytes.size() < kHeaderSize) fail(bytes.size(), "the header is cut: expected 16 bytes");
  if (base::get<std::uint32_t>(bytes, 12) != base::checksum(bytes.first(12))) fail(12, "the header is damaged");
  if (const auto version = base::get<std::uint32_t>(bytes, 8); version != kVersion)
    fail(8, "journal version " + std::to_string(version) + ", expected " + std::to_string(kVersion));
  return kHeaderSize;
}

std::optional<Record> whole_record(View bytes) {
  if (!record_header_at(bytes)) return std::nullopt;
  const std::size_t size = base::get<std::uint32_t>(bytes, 8), most = bytes.size() - kRecordHeaderSize;
  if (most < kRecordTailSize || most - kRecordTailSize < size) return std::nullopt;
  const View payload = bytes.subspan(kRecordHeaderSize, size);
  if (base::get<std::uint32_t>(bytes, kRecordHeaderSize + size) != base::checksum(payload)) return std::nullopt;
  return Record{base::get<std::uint32_t>(bytes, 4), payload, kRecordHeaderSize + size + kRecordTailSize};
}

bool record_follows(View bytes) {
  for (std::size_t at = 1; at + kRecordHeaderSize <= bytes.size(); ++at)
    if (record_header_at(bytes.subspan(at))) return true;
  return false;
}

void apply_record(const Record& record, Journal& journal) {
  base::ByteReader from(record.payload);
  switch (record.kind) {
    case kStock:
    case kMaskedStock: {
      JournalStock stock;
      for (Vec3* corner : {&stock.box.lower, &stock.box.upper})
        for (int k = 0; k < 3; ++k) (*corner)[k] = from.number<double>();
      stock.pitch = from.number<double>();
      stock.directions = from.text();
      stock.snapshot = from.text();
      if (record.kind == kMaskedStock) stock.mask = from.text();
      journal.set_stock(std::move(stock));
      break;
    }
    case kTool: {
      const std::uint32_t number = from.number<std::uint32_t>();
      journal.add_tool(static_cast<int>(number), from.text());
      break;
    }
    case kNote: {
      std::string key = from.text();
      journal.add_note(std::move(key), from.text());
      break;
    }
    case kStroke:
    case kClayStroke: {
      JournalStroke stroke;
      stroke.tool = static_cast<int>(from.number<std::uint32_t>());
      stroke.tolerance = from.number<double>();
      stroke.name = from.text();
      take_rows(from, stroke);
      if (record.kind == kClayStroke) stroke.mode = known_mode(from.number<std::uint32_t>());
      if (stroke.mode == StrokeMode::Soften || is_brush(stroke.mode)) stroke.strength = from.number<double>();
      if (is_brush(stroke.mode))
        stroke.amount = from.number<double>(), stroke.falloff = known_falloff(from.number<std::uint32_t>());
      journal.add_stroke(std::move(stroke));
      break;
    }
    case kMore: {
      JournalStroke more;
      take_rows(from, more);
      journal.extend_stroke(more.rows());
      break;
    }
    case kTakeBack: {
      journal.undo(from.number<std::uint64_t>());
      break;
    }
    case kBringBack: {
      journal.redo(from.number<std::uint64_t>());
      break;
    }
    default:
      throw std::invalid_argument("a record of kind " + std::to_string(record.kind) +
                                  ", unknown here: a newer Riffler wrote it");
  }
  from.done();
}

}  // namespace riffler::session::journal_format
