#include "riffler/session/journal_file.hpp"

#include <optional>
#include <stdexcept>
#include <utility>

#include "base/io.hpp"
#include "base/locked_file.hpp"
#include "base/path_text.hpp"
#include "riffler/base/error.hpp"
#include "session/journal_records.hpp"

namespace riffler::session {

using namespace journal_format;

Journal parse_journal(View bytes, const std::string& name, const Progress& progress) {
  constexpr std::size_t kRecordsAReport = 1024;
  Journal journal;
  std::size_t records = 0;
  for (std::size_t at = check_header(bytes, name); at < bytes.size();) {
    if (records++ % kRecordsAReport == 0)
      base::report(progress, static_cast<double>(at) / static_cast<double>(bytes.size()));
    const View rest = bytes.subspan(at);
    const std::optional<Record> record = whole_record(rest);
    const std::string where = "byte " + std::to_string(at);
    if (!record) {
      if (record_follows(rest)) throw FormatError(name, where, "a damaged record");
      journal.cut_at = at;
      break;
    }
    try {
      apply_record(*record, journal);
    } catch (const std::invalid_argument& e) {
      throw FormatError(name, where, e.what());
    }
    at += record->size;
  }
  return journal;
}

Journal read_journal(const std::filesystem::path& path, const Progress& progress) {
  return parse_journal(base::read_file(path), base::file_name(path), progress);
}

std::vector<std::uint8_t> to_bytes(const Journal& journal) {
  Bytes out = journal_header();
  const auto add = [&](const Bytes& bytes) { out.insert(out.end(), bytes.begin(), bytes.end()); };
  for (const auto& [key, value] : journal.notes()) add(note_record(key, value));
  if (journal.stock()) add(stock_record(*journal.stock()));
  for (const auto& [number, json] : journal.tools()) add(tool_record(number, json));
  for (const auto strokes : {journal.strokes(), journal.taken_back()})
    for (const JournalStroke& stroke : strokes) add(stroke_record(stroke));
  if (const std::size_t n = journal.taken_back().size()) add(undo_record(n));
  return out;
}

void write_journal(const Journal& journal, const std::filesystem::path& path) {
  base::write_file(path, to_bytes(journal));
}

// --- Appending ---

struct JournalWriter::File : base::LockedFile {
  using LockedFile::LockedFile;
};

JournalWriter::JournalWriter(const std::filesystem::path& path, Keep keep) : name_(base::file_name(path)) {
  file_ = std::make_unique<File>(path);
  Journal journal;
  if (file_->size() == 0) {
    append(journal_header());
  } else {
    const Bytes bytes = base::read_file(path);
    journal = parse_journal(bytes, name_);
    size_ = journal.cut_at.value_or(bytes.size());
    if (journal.cut_at && !file_->cut(size_)) file_->fail("its cut tail cannot be removed");
  }
  rules_ = journal.rules();
  if (keep == Keep::Everything) journal_ = std::move(journal);
}

JournalWriter::~JournalWriter() = default;

void JournalWriter::close() {
  file_.reset();
}

const Journal& JournalWriter::journal() const {
  if (!journal_) throw std::runtime_error(name_ + ": its writer does not keep what it wrote: read the file");
  return *journal_;
}

void JournalWriter::append(const std::vector<std::uint8_t>& bytes) {
  if (!file_) throw std::runtime_error(name_ + ": closed");
  // On a full disk, half a record may be written: a truncated tail, which this removes or the next record overwrites.
  const auto cut = [&] { torn_ = torn_ && !file_->cut(size_); };
  cut();
  try {
    file_->write_at(bytes, size_);
  } catch (...) {
    torn_ = true;
    cut();
    throw;
  }
  size_ += bytes.size();
}

/// Applies the change once its record is in the file, if the rules allow it.
template <class Apply, class Record>
void JournalWriter::change(const Apply& apply, const Record& record) {
  JournalRules after = rules_;
  apply(after);
  append(record());
  rules_ = std::move(after);
  if (journal_) apply(*journal_);
}

void JournalWriter::set_stock(const JournalStock& stock) {
  change([&](auto& to) { to.set_stock(stock); }, [&] { return stock_record(stock); });
}

void JournalWriter::add_tool(int number, const std::string& json) {
  change([&](auto& to) { to.add_tool(number, json); }, [&] { return tool_record(number, json); });
}

void JournalWriter::add_note(const std::string& key, const std::string& value) {
  append(note_record(key, value));
  if (journal_) journal_->add_note(key, value);
}

void JournalWriter::add_stroke(const JournalStroke& stroke) {
  change([&](auto& to) { to.add_stroke(stroke); }, [&] { return stroke_record(stroke); });
}

void JournalWriter::extend_stroke(const JournalRows& rows) {
  change([&](auto& to) { to.extend_stroke(rows); }, [&] { return more_record(rows); });
}

void JournalWriter::undo(std::size_t n) {
  change([&](auto& to) { to.undo(n); }, [&] { return undo_record(n); });
}

void JournalWriter::redo(std::size_t n) {
  change([&](auto& to) { to.redo(n); }, [&] { return redo_record(n); });
}

void JournalWriter::sync() {
  if (!file_) throw std::runtime_error(name_ + ": closed");
  file_->flush();
}

}  // namespace riffler::session
