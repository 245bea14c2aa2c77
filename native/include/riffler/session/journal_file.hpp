// The .rjournal file: a header and records, each whole or not there.
//
//   header   8 bytes "RIFFLERJ", u32 version (1), u32 CRC-32 of the 12 bytes before
//   record   4 bytes "RREC", u32 kind, u32 size of the payload, u32 CRC-32 of the 12 bytes before,
//            payload, u32 CRC-32 of the payload
//
// Little endian. A record is written with one call and never changed, so a crash can cut the last one only. The version
// is that of header and records; what a record may hold grows by kinds and columns, and a reader names those that it
// does not know.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/session/journal.hpp"

namespace riffler::session {

/// `name` stands in messages. FormatError naming the byte: not a journal, another version, a damaged record that others
/// follow, a record whose content is wrong. What follows the last whole record otherwise is a tail that a crash has
/// cut: Journal::cut_at says where.
Journal parse_journal(std::span<const std::uint8_t> bytes, const std::string& name, const Progress& progress = {});
Journal read_journal(const std::filesystem::path& path, const Progress& progress = {});

std::vector<std::uint8_t> to_bytes(const Journal& journal);
/// Written beside and renamed.
void write_journal(const Journal& journal, const std::filesystem::path& path);

/// Appends to a journal on disk, each record handed to the system before the call returns: a crash of the program loses
/// none, and a long stroke written in pieces loses at most the last. sync() is for a crash of the machine.
class JournalWriter {
 public:
  /// What the writer has in memory: all that is in the file, or what its checks need, which does not grow with rows and
  /// strokes.
  enum class Keep { Everything, Rules };

  /// Goes on with a journal that is there, after cutting a damaged tail off, or begins a new one.
  /// FormatError as read_journal; std::runtime_error where the file cannot be written.
  explicit JournalWriter(const std::filesystem::path& path, Keep keep = Keep::Everything);
  JournalWriter(const JournalWriter&) = delete;
  JournalWriter& operator=(const JournalWriter&) = delete;
  ~JournalWriter();

  /// As the functions of Journal: what it refuses is not written; what could not be written is not known here either.
  void set_stock(const JournalStock& stock);
  void add_tool(int number, const std::string& json);
  void add_note(const std::string& key, const std::string& value);
  void add_stroke(const JournalStroke& stroke);
  void extend_stroke(const JournalRows& rows);
  void undo(std::size_t n = 1);
  void redo(std::size_t n = 1);

  /// Another thread may go on writing meanwhile.
  void sync();
  /// Ends writing; a call after it throws std::runtime_error.
  void close();
  /// Everything in the file; std::runtime_error where only the rules are kept.
  const Journal& journal() const;
  const JournalRules& rules() const { return rules_; }

 private:
  template <class Apply, class Record>
  void change(const Apply& apply, const Record& record);
  void append(const std::vector<std::uint8_t>& record);
  void append_to(int fd, const std::vector<std::uint8_t>& bytes);

  std::string name_;
  JournalRules rules_;
  std::optional<Journal> journal_;
  int fd_ = -1;
  std::uint64_t size_ = 0;  // bytes of whole records
  bool torn_ = false;       // a piece of a record may follow them
};

}  // namespace riffler::session
