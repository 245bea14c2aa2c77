#include "riffler/nc/program_file.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <stdexcept>

#include "base/bytes.hpp"
#include "base/io.hpp"
#include "base/path_text.hpp"
#include "base/planes.hpp"
#include "riffler/base/error.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::nc {

namespace {

constexpr std::array<std::uint8_t, 8> kMagic{0x89, 'R', 'P', 'R', 'G', '\r', '\n', 0x1A};
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kHeader = 40, kRecordHeader = 20;
/// Large enough for deflate, small enough to use every thread.
constexpr std::size_t kChunkRows = 32768;
constexpr std::uint32_t kNotes = 0x65746F6E, kTool = 0x6C6F6F74, kRows = 0x73776F72,
                        kVia = 0x20616976;  // "note", "tool", "rows", "via "
constexpr std::size_t kDoubles = 8;         // doubles per row: tip, axis, feed, spindle

double number_of(const Program& program, std::size_t row, std::size_t column) {
  const Pose& pose = program.poses()[row];
  if (column < 3) return pose.tip[static_cast<int>(column)];
  if (column < 6) return pose.axis[static_cast<int>(column) - 3];
  return column == 6 ? program.feed()[row] : program.spindle()[row];
}

// --- Writing ---

Bytes record(std::uint32_t kind, std::size_t number, const Bytes& payload) {
  Bytes out;
  out.reserve(kRecordHeader + payload.size());
  base::put(out, kind);
  base::put(out, static_cast<std::uint32_t>(number));
  base::put(out, static_cast<std::uint64_t>(payload.size()));
  base::put(out, base::checksum(out, payload));
  out.insert(out.end(), payload.begin(), payload.end());
  return out;
}

Bytes notes_record(const Provenance& notes) {
  Bytes out;
  for (const auto& [key, value] : notes) base::put_text(out, key), base::put_text(out, value);
  return record(kNotes, notes.size(), out);
}

void put_count(Bytes& out, std::size_t count) {
  base::put(out, static_cast<std::uint32_t>(count));
}

void put_pieces(Bytes& out, const std::vector<tool::Frustum>& pieces) {
  put_count(out, pieces.size());
  for (const tool::Frustum& f : pieces) base::put(out, std::array{f.z0, f.r0, f.z1, f.r1});
}

constexpr std::string_view kNote = "note:";

/// The provenance, followed by the reader's notes.
Provenance with_notes(const Program& program) {
  Provenance out = program.provenance;
  for (const Note& n : program.notes)
    out.emplace_back(std::string(kNote) + std::to_string(n.line) + ":" + n.kind, n.message);
  return out;
}

/// Takes the notes out of the provenance; a key that only resembles a note stays.
void take_notes(Program& program) {
  std::erase_if(program.provenance, [&](const auto& entry) {
    std::string_view key = entry.first;
    if (!key.starts_with(kNote)) return false;
    key.remove_prefix(kNote.size());
    int line = 0;
    const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), line);
    if (error != std::errc() || line < 0 || end == key.data() + key.size() || *end != ':') return false;
    program.notes.push_back(
        {std::string(key.substr(static_cast<std::size_t>(end + 1 - key.data()))), line, entry.second});
    return true;
  });
}

Bytes tool_record(int number, const Tool& tool) {
  Bytes out;
  base::put_text(out, tool.kind());
  base::put_text(out, tool.name());
  put_count(out, tool.parameters().size());
  for (const auto& [name, value] : tool.parameters()) base::put_text(out, name), base::put(out, value);
  put_count(out, tool.profile().segments().size());
  for (const tool::ProfileSegment& segment : tool.profile().segments()) {
    put_count(out, segment.centre.has_value());
    base::put(out, std::array{segment.to.x, segment.to.y});
    if (segment.centre) base::put(out, std::array{segment.centre->x, segment.centre->y});
  }
  put_pieces(out, tool.shank());
  put_pieces(out, tool.holder());
  return record(kTool, static_cast<std::size_t>(number), out);
}

Bytes rows_record(const Program& program, std::size_t first, std::size_t count) {
  Bytes out;
  base::PlaneWriter planes(out);
  std::vector<std::uint64_t> doubles(count);
  for (std::size_t column = 0; column < kDoubles; ++column) {
    for (std::size_t k = 0; k < count; ++k)
      doubles[k] = std::bit_cast<std::uint64_t>(number_of(program, first + k, column));
    planes.column(doubles);
  }
  std::vector<std::uint32_t> numbers(count);
  for (const std::vector<std::int32_t>* column : {&program.tool(), &program.line()}) {
    for (std::size_t k = 0; k < count; ++k) numbers[k] = static_cast<std::uint32_t>((*column)[first + k]);
    planes.column(numbers);
  }
  std::vector<std::uint16_t> flags(count);
  for (std::size_t k = 0; k < count; ++k)
    flags[k] = static_cast<std::uint16_t>(program.rapid()[first + k] | program.at_machine()[first + k] << 1);
  planes.column(flags);
  return record(kRows, count, out);
}

Bytes via_record(std::size_t row, const std::vector<Pose>& via) {
  Bytes out;
  put_count(out, via.size());
  for (const Pose& p : via) base::put(out, std::array{p.tip.x, p.tip.y, p.tip.z, p.axis.x, p.axis.y, p.axis.z});
  return record(kVia, row, out);
}

// --- Reading ---

struct Record {
  std::size_t at;  ///< byte offset in the file
  std::uint32_t kind, number;
  ByteView payload;
};

struct Columns {
  std::array<std::vector<std::uint64_t>, kDoubles> doubles;
  std::vector<std::uint32_t> tool, line;
  std::vector<std::uint16_t> flags;

  double number(std::size_t row, std::size_t column) const { return std::bit_cast<double>(doubles[column][row]); }
  Vec3 vector(std::size_t row, std::size_t first) const {
    return {number(row, first), number(row, first + 1), number(row, first + 2)};
  }
};

class Reader {
 public:
  Reader(ByteView bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  Program run(const Progress& progress) {
    check_header();
    const std::vector<Record> all = records();
    Program program;
    program.provenance = notes(all[0]);
    take_notes(program);
    for (std::size_t k = 1; k <= tools_; ++k) add_tool(all[k], program.tools);
    const std::size_t rows = 1 + tools_ + take_vias(std::span(all).subspan(1 + tools_));
    add_rows(std::span(all).subspan(rows), program, progress);
    return program;
  }

 private:
  [[noreturn]] void fail(std::size_t at, const std::string& what) const {
    throw FormatError(name_, "byte " + std::to_string(at), what);
  }

  void check_header() {
    if (bytes_.size() < kMagic.size() || !std::equal(kMagic.begin(), kMagic.end(), bytes_.begin()))
      fail(0, "not a .rprog file (its first eight bytes differ)");
    if (bytes_.size() < kHeader) fail(bytes_.size(), "the file ends within its header");
    if (base::get<std::uint32_t>(bytes_, kHeader - 4) != base::checksum(bytes_.first(kHeader - 4)))
      fail(kHeader - 4, "the header's checksum does not match");
    const auto version = base::get<std::uint32_t>(bytes_, 8);
    if (version != kVersion)
      fail(8, "version " + std::to_string(version) + "; this program reads version " + std::to_string(kVersion));
    const auto length = base::get<std::uint64_t>(bytes_, 16);
    if (bytes_.size() < length)
      fail(bytes_.size(), "the file ends here, but should have " + std::to_string(length) + " bytes");
    if (bytes_.size() > length) fail(length, "there is more after the file's end");
    tools_ = base::get<std::uint32_t>(bytes_, 12);
    rows_ = base::get<std::uint64_t>(bytes_, 24);
    notes_ = base::get<std::uint32_t>(bytes_, 32);
  }

  /// Records in their required order; the payloads of rows are decoded later, in parallel.
  std::vector<Record> records() const {
    std::vector<Record> all;
    std::uint64_t rows = 0;
    for (std::size_t at = kHeader; at < bytes_.size();) {
      if (bytes_.size() - at < kRecordHeader) fail(at, "the file ends where a record should begin");
      const ByteView head = bytes_.subspan(at);
      const auto length = base::get<std::uint64_t>(head, 8);
      if (length > head.size() - kRecordHeader) fail(at + 8, "the record is longer than the rest of the file");
      const Record record{at, base::get<std::uint32_t>(head, 0), base::get<std::uint32_t>(head, 4),
                          head.subspan(kRecordHeader, length)};
      if (base::get<std::uint32_t>(head, 16) != base::checksum(head.first(16), record.payload))
        fail(at, "the record's checksum does not match");
      const bool via = record.kind == kVia && all.size() > tools_ && all.back().kind != kRows;
      if (!via && record.kind != (all.empty() ? kNotes : all.size() <= tools_ ? kTool : kRows))
        fail(at, "a record of another kind than expected");
      if (record.kind == kRows) {
        if (record.number == 0 || record.number > kChunkRows) fail(at + 4, "a record holds 1 to 32768 rows");
        rows += record.number;
      }
      all.push_back(record);
      at += kRecordHeader + length;
    }
    if (all.size() < 1 + std::size_t{tools_}) fail(bytes_.size(), "the file ends before its last tool");
    if (rows != rows_)
      fail(24, "the header announces " + std::to_string(rows_) + " rows, the records hold " + std::to_string(rows));
    return all;
  }

  /// Decodes the record's payload with `take`; errors name the record's byte.
  template <class Take>
  auto taken(const Record& record, const Take& take) const {
    base::ByteReader from(record.payload);
    try {
      auto out = take(from);
      from.done();
      return out;
    } catch (const std::invalid_argument& e) {
      fail(record.at, e.what());
    }
  }

  Provenance notes(const Record& record) const {
    if (record.number != notes_) fail(record.at + 4, "the header announces another number of notes");
    return taken(record, [&](base::ByteReader& from) {
      Provenance out;
      for (std::uint32_t k = 0; k < record.number; ++k) {
        std::string key = from.text();
        out.emplace_back(std::move(key), from.text());
      }
      return out;
    });
  }

  static Vec2 take_point(base::ByteReader& from) {
    const double x = from.number<double>();
    return {x, from.number<double>()};
  }

  static std::vector<tool::Frustum> take_pieces(base::ByteReader& from) {
    std::vector<tool::Frustum> out;
    for (auto count = from.number<std::uint32_t>(); count > 0; --count) {
      const auto numbers = from.number<std::array<double, 4>>();
      out.push_back({numbers[0], numbers[1], numbers[2], numbers[3]});
    }
    return out;
  }

  static Tool take_tool(base::ByteReader& from) {
    const std::string kind = from.text(), name = from.text();
    std::vector<std::pair<std::string, double>> parameters;
    for (auto count = from.number<std::uint32_t>(); count > 0; --count) {
      std::string key = from.text();
      parameters.emplace_back(std::move(key), from.number<double>());
    }
    std::vector<tool::ProfileSegment> segments;
    for (auto count = from.number<std::uint32_t>(); count > 0; --count) {
      const auto centre = from.number<std::uint32_t>();
      if (centre > 1) throw std::invalid_argument("a segment of the profile is neither line nor arc");
      tool::ProfileSegment segment{take_point(from), {}};
      if (centre) segment.centre = take_point(from);
      segments.push_back(segment);
    }
    Tool tool(kind, std::move(parameters), tool::Profile(std::move(segments)));
    tool = tool.with_shank(take_pieces(from));
    return tool.with_holder(take_pieces(from)).named(name);
  }

  void add_tool(const Record& record, std::map<int, Tool>& tools) const {
    const int number = static_cast<int>(record.number);
    if (number < 0 || (!tools.empty() && number <= tools.rbegin()->first))
      fail(record.at + 4, "the tools' numbers are not ascending");
    tools.emplace(number, taken(record, &Reader::take_tool));
  }

  /// Takes the "via " records at the beginning of `records`; returns their number.
  std::size_t take_vias(std::span<const Record> records) {
    std::size_t count = 0, last = 0;
    for (const Record& record : records) {
      if (record.kind != kVia) break;
      if (record.number <= last || record.number >= rows_)
        fail(record.at + 4, "via poses without a row, or not in order");
      vias_.emplace(record.number, taken(record, [&](base::ByteReader& from) {
                      auto out = std::make_shared<std::vector<Pose>>();
                      for (auto k = from.number<std::uint32_t>(); k > 0; --k) {
                        const auto n = from.number<std::array<double, 6>>();
                        out->push_back(checked_pose({{n[0], n[1], n[2]}, {n[3], n[4], n[5]}}, "via", record.number));
                      }
                      if (out->empty()) throw std::invalid_argument("a row without via poses");
                      return std::shared_ptr<const std::vector<Pose>>(std::move(out));
                    }));
      last = record.number, ++count;
    }
    return count;
  }

  Columns columns(const Record& record) const {
    base::PlaneReader planes(record.payload, record.at + kRecordHeader, name_);
    Columns out;
    for (auto& column : out.doubles) column = planes.column64(record.number);
    out.tool = planes.column32(record.number);
    out.line = planes.column32(record.number);
    out.flags = planes.column16(record.number);
    planes.finish();
    return out;
  }

  void add_rows(std::span<const Record> records, Program& program, const Progress& progress) const {
    std::vector<Columns> read(records.size());
    base::parallel_for(
        records.size(), 1,
        [&](std::size_t begin, std::size_t end) {
          for (std::size_t k = begin; k < end; ++k) read[k] = columns(records[k]);
        },
        base::part(progress, 0, 0.8));
    program.reserve(rows_);
    for (std::size_t k = 0; k < records.size(); ++k) {
      base::report(progress, 0.8 + 0.2 * static_cast<double>(k) / static_cast<double>(records.size()));
      add_rows(records[k], read[k], program);
    }
    base::report(progress, 1);
  }

  /// Adds rows as Program::append does. A valid file holds rows that append would leave unchanged; a row that append
  /// would change was not written by Riffler and is an error.
  void add_rows(const Record& record, const Columns& columns, Program& program) const {
    for (std::size_t k = 0; k < record.number; ++k) {
      if (columns.flags[k] > 3) fail(record.at, "a row has unknown flags");
      const Move move{{columns.vector(k, 0), columns.vector(k, 3)},
                      columns.number(k, 6),
                      columns.number(k, 7),
                      static_cast<int>(columns.tool[k]),
                      static_cast<int>(columns.line[k]),
                      (columns.flags[k] & 1) != 0,
                      (columns.flags[k] & 2) != 0,
                      vias_.contains(program.size()) ? vias_.at(program.size()) : nullptr};
      try {
        program.append(move);
      } catch (const std::invalid_argument& e) {
        fail(record.at, e.what());
      }
      const Move kept = program[program.size() - 1];
      if (kept.pose.axis != move.pose.axis || kept.feed != move.feed)
        fail(record.at, "row " + std::to_string(program.size() - 1) + " has values that no program can hold");
    }
  }

  ByteView bytes_;
  const std::string& name_;
  std::uint32_t tools_ = 0, notes_ = 0;
  std::uint64_t rows_ = 0;
  std::map<std::size_t, std::shared_ptr<const std::vector<Pose>>> vias_;
};

}  // namespace

std::vector<std::uint8_t> to_bytes(const Program& program, const Progress& progress) {
  const Provenance noted = with_notes(program);
  std::vector<Bytes> records{notes_record(noted)};
  for (const auto& [number, tool] : program.tools) records.push_back(tool_record(number, tool));
  for (const auto& [row, via] : program.via()) records.push_back(via_record(row, *via));
  const std::size_t before = records.size(), chunks = (program.size() + kChunkRows - 1) / kChunkRows;
  records.resize(before + chunks);
  base::parallel_for(
      chunks, 1,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
          const std::size_t first = k * kChunkRows;
          records[before + k] = rows_record(program, first, std::min(kChunkRows, program.size() - first));
        }
      },
      progress);
  std::uint64_t length = kHeader;
  for (const Bytes& bytes : records) length += bytes.size();
  Bytes out;
  out.reserve(length);
  base::put(out, kMagic);
  base::put(out, kVersion);
  put_count(out, program.tools.size());
  base::put(out, length);
  base::put(out, static_cast<std::uint64_t>(program.size()));
  put_count(out, noted.size());
  base::put(out, base::checksum(out));
  for (const Bytes& bytes : records) out.insert(out.end(), bytes.begin(), bytes.end());
  return out;
}

Program parse_program(ByteView bytes, const std::string& name, const Progress& progress) {
  return Reader(bytes, name).run(progress);
}

void save_program(const Program& program, const std::filesystem::path& path, const Progress& progress) {
  base::write_file(path, to_bytes(program, progress));
}

Program load_program(const std::filesystem::path& path, const Progress& progress) {
  return parse_program(base::read_file(path), base::file_name(path), progress);
}

}  // namespace riffler::nc
