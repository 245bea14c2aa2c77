// The bytes of a journal's header and records. Used only by journal_file.cpp.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/bytes.hpp"
#include "riffler/session/journal.hpp"

namespace riffler::session::journal_format {

using View = ByteView;

Bytes journal_header();
Bytes stock_record(const JournalStock& stock);
Bytes tool_record(int number, const std::string& json);
Bytes note_record(const std::string& key, const std::string& value);
Bytes stroke_record(const JournalStroke& stroke);
Bytes more_record(const JournalRows& rows);
Bytes undo_record(std::size_t n);
Bytes redo_record(std::size_t n);

/// The size of the header at the start of `bytes`. Throws FormatError (`name`) if it is not that of a journal.
std::size_t check_header(View bytes, const std::string& name);

/// A record with valid checksums.
struct Record {
  std::uint32_t kind;
  View payload;
  std::size_t size;  ///< bytes, with header and checksums
};

/// The complete record at the start of `bytes`, or no value.
std::optional<Record> whole_record(View bytes);
/// Whether another record begins anywhere after the first byte.
bool record_follows(View bytes);
/// Applies the record to the journal. Throws std::invalid_argument for invalid content.
void apply_record(const Record& record, Journal& journal);

}  // namespace riffler::session::journal_format
