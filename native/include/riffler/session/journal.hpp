// The journal of a session: the initial stock, the tools, and every stroke as poses. A snapshot plus a log: replaying
// it reproduces the session.
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

/// A journal in memory. Strokes keep their order; a tool number always means the same tool.
class Journal {
 public:
  /// The functions that change the journal throw as JournalRules and then leave it unchanged. Numbers are stored
  /// exactly.
  void set_stock(const JournalStock& stock);
  /// `json`: the tool's dict as JSON text.
  void add_tool(int number, const std::string& json);
  /// Adds a key/value note on the journal's origin.
  void add_note(std::string key, std::string value);
  /// Adds a stroke; undone strokes are discarded for good.
  void add_stroke(JournalStroke stroke);
  /// Appends rows to the last stroke, with the same columns.
  void extend_stroke(const JournalRows& rows);
  /// Undoes the last n strokes, and redoes them, the last undone first. Either ends the last stroke.
  void undo(std::size_t n = 1);
  void redo(std::size_t n = 1);

  const std::optional<JournalStock>& stock() const { return rules_.stock(); }
  const std::map<int, std::string>& tools() const { return rules_.tools(); }
  const std::vector<std::pair<std::string, std::string>>& notes() const { return notes_; }
  /// The strokes that count: not undone.
  std::span<const JournalStroke> strokes() const { return std::span(strokes_).first(rules_.counting()); }
  /// The undone strokes that can be redone, in their original order.
  std::span<const JournalStroke> taken_back() const { return std::span(strokes_).subspan(rules_.counting()); }
  const JournalRules& rules() const { return rules_; }

  /// Byte offset at which a truncated file was cut, after its last complete record; no value for a complete file.
  std::optional<std::uint64_t> cut_at;

 private:
  JournalRules rules_;
  std::vector<std::pair<std::string, std::string>> notes_;
  std::vector<JournalStroke> strokes_;  // the strokes that count come first
};

/// Options of to_program.
struct JournalProgramOptions {
  std::optional<double> feed;  ///< mm/min; default: each row's feed follows from its times
  double spindle = 0;          ///< rev/min
  nc::Clearance clearance;     ///< the stock's box is added to `occupied`
};

/// A program with each removing stroke as one cut; strokes that add or protect material are omitted, since no machine
/// can make them. Feeds from times are clamped to 1 to 100 000 mm/min; a row whose tip stands still takes the feed of
/// the row before. Throws std::invalid_argument if no feed is given and a stroke has no times or never moves.
nc::Program to_program(const Journal& journal, std::map<int, Tool> tools, const JournalProgramOptions& options = {});

}  // namespace riffler::session
