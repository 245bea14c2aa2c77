// The .rjournal file: a header and records, each of them complete or absent.
//
//   header   8 bytes "RIFFLERJ", u32 version (1), u32 CRC-32 of the 12 bytes before
//   record   4 bytes "RREC", u32 kind, u32 size of the payload, u32 CRC-32 of the 12 bytes before,
//            payload, u32 CRC-32 of the payload
//
// Little endian. A record is written with one call and never changed, so a crash can truncate only the last one. The
// version covers header and record layout; new content comes as new record kinds and columns, and a reader reports
// those that it does not know.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/session/journal.hpp"

namespace riffler::session {

/// Reads a journal from bytes. `name` identifies the file in messages. Throws FormatError naming the byte: not a
/// journal, another version, a damaged record followed by others, a record with invalid content. Anything else after
/// the last complete record is the tail left by a crash: Journal::cut_at gives its offset.
Journal parse_journal(std::span<const std::uint8_t> bytes, const std::string& name, const Progress& progress = {});
/// As parse_journal, for a file. Throws FormatError if it cannot be read.
Journal read_journal(const std::filesystem::path& path, const Progress& progress = {});

/// The bytes of a journal file.
std::vector<std::uint8_t> to_bytes(const Journal& journal);
/// Writes the file atomically, under a temporary name that is then renamed.
void write_journal(const Journal& journal, const std::filesystem::path& path);

/// Appends to a journal on disk. Each record is passed to the system before the call returns: a crash of the program
/// loses none, and of a long stroke written in pieces at most the last piece. Use sync() to survive a crash of the
/// machine.
class JournalWriter {
 public:
  /// What the writer keeps in memory: the complete journal, or only the state of its checks, which does not grow with
  /// rows and strokes.
  enum class Keep { Everything, Rules };

  /// Continues an existing journal, after removing a damaged tail, or creates a new one. Throws FormatError as
  /// read_journal; std::runtime_error if the file cannot be written.
  explicit JournalWriter(const std::filesystem::path& path, Keep keep = Keep::Everything);
  JournalWriter(const JournalWriter&) = delete;
  JournalWriter& operator=(const JournalWriter&) = delete;
  ~JournalWriter();

  /// As the functions of Journal: what it refuses is not written, and what could not be written is not added here
  /// either.
  void set_stock(const JournalStock& stock);
  void add_tool(int number, const std::string& json);
  void add_note(const std::string& key, const std::string& value);
  void add_stroke(const JournalStroke& stroke);
  void extend_stroke(const JournalRows& rows);
  void undo(std::size_t n = 1);
  void redo(std::size_t n = 1);

  /// Flushes the file to disk. Another thread may write meanwhile.
  void sync();
  /// Closes the file; later calls throw std::runtime_error.
  void close();
  /// The journal as in the file. Throws std::runtime_error with Keep::Rules.
  const Journal& journal() const;
  const JournalRules& rules() const { return rules_; }

 private:
  struct File;
  template <class Apply, class Record>
  void change(const Apply& apply, const Record& record);
  void append(const std::vector<std::uint8_t>& record);

  std::string name_;
  JournalRules rules_;
  std::optional<Journal> journal_;
  std::unique_ptr<File> file_;  // none once closed
  std::uint64_t size_ = 0;      // bytes of complete records
  bool torn_ = false;           // a partial record may follow them
};

}  // namespace riffler::session
