// The journal of a session: what stock it began with, which tools, and every stroke as poses. Snapshot + log: replaying
// it gives the session again.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "riffler/nc/cutter_path.hpp"
#include "riffler/nc/program.hpp"
#include "riffler/session/journal_rules.hpp"

namespace riffler::session {

/// In memory. Strokes keep their order; a tool's number means one tool for good.
class Journal {
 public:
  /// Each throws as JournalRules does and leaves the journal as it was. Numbers are kept to the bit.
  void set_stock(const JournalStock& stock);
  /// `json`: the tool's dict as JSON text.
  void add_tool(int number, const std::string& json);
  void add_note(std::string key, std::string value);
  /// Strokes that were taken back are gone for good with it.
  void add_stroke(JournalStroke stroke);
  /// More rows for the stroke that was added last, with the same columns.
  void extend_stroke(const JournalRows& rows);
  /// The last n strokes no longer count (undo), and count again (redo), those taken back last first. The last stroke
  /// has ended with either.
  void undo(std::size_t n = 1);
  void redo(std::size_t n = 1);

  const std::optional<JournalStock>& stock() const { return rules_.stock(); }
  const std::map<int, std::string>& tools() const { return rules_.tools(); }
  const std::vector<std::pair<std::string, std::string>>& notes() const { return notes_; }
  /// Those that count.
  std::span<const JournalStroke> strokes() const { return std::span(strokes_).first(rules_.counting()); }
  /// Those that can be brought back, in the order in which they were made.
  std::span<const JournalStroke> taken_back() const { return std::span(strokes_).subspan(rules_.counting()); }
  const JournalRules& rules() const { return rules_; }

  /// The byte at which the file that this was read from had been cut, after its last whole record; nothing for a whole
  /// file.
  std::optional<std::uint64_t> cut_at;

 private:
  JournalRules rules_;
  std::vector<std::pair<std::string, std::string>> notes_;
  std::vector<JournalStroke> strokes_;  // first those that count
};

struct JournalProgramOptions {
  std::optional<double> feed;  ///< mm/min; without it each row's feed follows from its times
  double spindle = 0;          ///< rev/min
  nc::Clearance clearance;     ///< the stock's box is added to what is occupied
};

/// Each stroke that removes as one cut; what others put on or protect no machine can make. Feeds from times are held
/// within 1 to 100 000 mm/min; a row whose tip stands still has the feed of the row before. Throws
/// std::invalid_argument where a stroke has no times, or never moves, and no feed is given.
nc::Program to_program(const Journal& journal, std::map<int, Tool> tools, const JournalProgramOptions& options = {});

}  // namespace riffler::session
