// The bytes of a journal's header and records. Only journal_file.cpp needs them.
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

/// The size of the header at the start of `bytes`. Throws FormatError (`name`) where it is not a journal's.
std::size_t check_header(View bytes, const std::string& name);

/// A record whose checksums are right.
struct Record {
  std::uint32_t kind;
  View payload;
  std::size_t size;  ///< with header and checksums
};

/// The whole record at the start of `bytes`, or nothing.
std::optional<Record> whole_record(View bytes);
/// Whether another record begins anywhere after the first byte.
bool record_follows(View bytes);
/// Adds what the record says. Throws std::invalid_argument where its content is wrong.
void apply_record(const Record& record, Journal& journal);

}  // namespace riffler::session::journal_format
