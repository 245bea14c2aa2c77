#include "riffler/session/journal_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <utility>

#include "base/io.hpp"
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
  return parse_journal(base::read_file(path), path.filename().string(), progress);
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

namespace {

[[noreturn]] void fail_system(const std::string& name, const char* what) {
  throw std::runtime_error(name + ": " + what + ": " + std::strerror(errno));
}

/// Owns a file descriptor until released.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  int get() const { return fd_; }
  int release() { return std::exchange(fd_, -1); }

 private:
  int fd_;
};

void write_at(int fd, View bytes, std::uint64_t at, const std::string& name) {
  while (!bytes.empty()) {
    const ssize_t n = pwrite(fd, bytes.data(), bytes.size(), static_cast<off_t>(at));
    if (n < 0 && errno == EINTR) continue;
    if (n == 0) errno = ENOSPC;  // no system does this, but none rules it out; retrying could loop for ever
    if (n <= 0) fail_system(name, "cannot be written");
    bytes = bytes.subspan(static_cast<std::size_t>(n));
    at += static_cast<std::uint64_t>(n);
  }
}

}  // namespace

JournalWriter::JournalWriter(const std::filesystem::path& path, Keep keep) : name_(path.filename().string()) {
  Descriptor file(open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666));
  if (file.get() < 0) fail_system(name_, "cannot be opened for writing");
  if (flock(file.get(), LOCK_EX | LOCK_NB) != 0) fail_system(name_, "is being written by another program");
  struct stat status{};
  if (fstat(file.get(), &status) != 0) fail_system(name_, "cannot be read");
  if (!S_ISREG(status.st_mode))
    throw std::runtime_error(name_ + ": is a pipe or a device, not a file: take another name");
  Journal journal;
  if (status.st_size == 0) {
    append_to(file.get(), journal_header());
  } else {
    const Bytes bytes = base::read_file(path);
    journal = parse_journal(bytes, name_);
    size_ = journal.cut_at.value_or(bytes.size());
    if (journal.cut_at && ftruncate(file.get(), static_cast<off_t>(size_)) != 0)
      fail_system(name_, "its cut tail cannot be removed");
  }
  rules_ = journal.rules();
  if (keep == Keep::Everything) journal_ = std::move(journal);
  fd_ = file.release();
}

JournalWriter::~JournalWriter() {
  close();
}

void JournalWriter::close() {
  if (fd_ >= 0) ::close(std::exchange(fd_, -1));
}

const Journal& JournalWriter::journal() const {
  if (!journal_) throw std::runtime_error(name_ + ": its writer does not keep what it wrote: read the file");
  return *journal_;
}

void JournalWriter::append(const std::vector<std::uint8_t>& bytes) {
  if (fd_ < 0) throw std::runtime_error(name_ + ": closed");
  append_to(fd_, bytes);
}

void JournalWriter::append_to(int fd, const std::vector<std::uint8_t>& bytes) {
  // On a full disk, half a record may be written: a truncated tail, which this removes or the next record overwrites.
  const auto cut = [&] { torn_ = torn_ && ftruncate(fd, static_cast<off_t>(size_)) != 0; };
  cut();
  try {
    write_at(fd, bytes, size_, name_);
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
  if (fd_ < 0) throw std::runtime_error(name_ + ": closed");
  if (fdatasync(fd_) != 0) fail_system(name_, "cannot be flushed to the disk");
}

}  // namespace riffler::session
