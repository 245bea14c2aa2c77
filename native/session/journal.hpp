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

#include "nc/cutter_path.hpp"
#include "nc/program.hpp"

namespace riffler {

/// The frame of the stock's volume, and the file of its snapshot where it is not the full block.
struct JournalStock {
  Box3 box;
  double pitch = 0;
  std::string directions = "z";  ///< "z" or "xyz"
  std::string snapshot;          ///< file name beside the journal (.rvol), or empty: a block
};

/// One stroke: what was carved in one go with one tool.
struct JournalStroke {
  int tool = 0;
  double tolerance = 0.01;  ///< mm, as carve() was given it
  std::string name;
  std::vector<Pose> poses;    ///< at least one
  std::vector<double> times;  ///< s, one per pose, never falling; or empty: not recorded
};

/// In memory. Strokes keep their order; a tool's number means one tool for good.
class Journal {
 public:
  /// Each throws std::invalid_argument saying what is wrong and leaves the journal as it was. A second stock, a number
  /// with another tool, and a stroke with a tool that is not there are wrong. Poses are kept to the bit.
  void set_stock(JournalStock stock);
  /// `json`: the tool's dict as JSON text.
  void add_tool(int number, std::string json);
  void add_note(std::string key, std::string value);
  void add_stroke(JournalStroke stroke);
  /// More poses for the last stroke, with times if it has times.
  void extend_stroke(std::span<const Pose> poses, std::span<const double> times);

  /// The same checks without the change.
  void check_stock(const JournalStock& stock) const;
  void check_tool(int number, const std::string& json) const;
  void check_stroke(const JournalStroke& stroke) const;
  void check_extension(std::span<const Pose> poses, std::span<const double> times) const;

  const std::optional<JournalStock>& stock() const { return stock_; }
  const std::map<int, std::string>& tools() const { return tools_; }
  const std::vector<std::pair<std::string, std::string>>& notes() const { return notes_; }
  const std::vector<JournalStroke>& strokes() const { return strokes_; }

  /// The byte at which the file that this was read from had been cut, after its last whole record; nothing for a whole
  /// file.
  std::optional<std::uint64_t> cut_at;

 private:
  std::optional<JournalStock> stock_;
  std::map<int, std::string> tools_;
  std::vector<std::pair<std::string, std::string>> notes_;
  std::vector<JournalStroke> strokes_;
};

struct JournalProgramOptions {
  std::optional<double> feed;  ///< mm/min; without it each row's feed follows from its times
  double spindle = 0;          ///< rev/min
  Clearance clearance;         ///< the stock's box is added to what is occupied
};

/// Each stroke as one cut. Feeds from times are held within 1 to 100 000 mm/min; a row whose tip stands still has the
/// feed of the row before. Throws std::invalid_argument where a stroke has no times, or never moves, and no feed is
/// given.
Program to_program(const Journal& journal, std::map<int, Tool> tools, const JournalProgramOptions& options = {});

}  // namespace riffler
