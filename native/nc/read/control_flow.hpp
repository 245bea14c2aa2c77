// Selects the next line of NC code: O-words (subroutines, loops, branches), subprograms by M98, files of subroutines.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "nc/read/cursor.hpp"
#include "nc/read/o_word.hpp"
#include "nc/read/parameters.hpp"
#include "nc/source.hpp"
#include "riffler/base/progress.hpp"

namespace riffler::nc {

class NcControlFlow {
 public:
  /// Subroutines not in the program are searched as name.ngc in `folders`. A program counts as endless after
  /// `max_turns` turns of loops and calls, or when they keep rereading lines without end. `progress` is also called for
  /// skipped lines. Keeps references to `place`, which it updates, and `parameters`.
  NcControlFlow(std::unique_ptr<NcSource> program, std::vector<std::filesystem::path> folders, double max_turns,
                NcPlace& place, NcParameters& parameters, Progress progress = {});

  /// The next line in execution order; false at the end. Throws FormatError if a file ends within a subroutine.
  bool next(std::string_view& line);

  /// Executes what follows "O" in a block. False: it is only a program number.
  bool execute(NcCursor& cursor);

  /// M98 and M99; false if M99 has nothing to return to.
  void call_subprogram(int number, int repeats);
  bool end_subprogram();

  /// Whether `line` begins subroutines, which may follow the end of the program.
  static bool begins_subroutine(std::string_view line);
  /// The line of the program (not of a subroutine file) being executed.
  int program_line() const;
  /// Number of active subroutines and subprograms.
  std::size_t depth() const { return frames_.size() - 1; }
  /// Whether an O-word was executed: lines after M2 may then belong to other turns.
  bool is_used() const { return used_; }

 private:
  struct File {
    std::unique_ptr<NcSource> source;
    std::map<std::string, NcSource::Mark> subs, subprograms;
    bool is_indexed = false;
    int furthest = 0;  // furthest line read
  };
  struct Loop {
    std::string label;
    NcKeyword kind;
    NcSource::Mark again;  // the line of while; the line after do and repeat
    double left = 0;       // turns of repeat left
  };
  struct Frame {
    File* file;
    std::string label;           // label of the subroutine
    bool is_subprogram = false;  // called by M98
    int repeats = 1;
    NcSource::Mark first, back{};  // its start, and where the caller continues
    std::vector<Loop> loops{};
  };

  void call(const std::string& label, const std::vector<double>& arguments);
  void leave(std::optional<double> value);
  void subroutine(const std::string& label, NcKeyword keyword, NcCursor& cursor);
  void branch(const std::string& label, NcKeyword keyword, NcCursor& cursor);
  void loop(const std::string& label, NcKeyword keyword, NcCursor& cursor);
  Loop* find_loop(const std::string& label);
  void next_turn(const std::string& label);
  void leave_loop(const std::string& label);
  /// Skips to the line of `label` with one of `keywords`: returns the keyword and the text after it.
  std::pair<NcKeyword, std::string_view> skip(const std::string& label, std::initializer_list<NcKeyword> keywords);
  std::pair<File*, NcSource::Mark> find(const std::string& label, bool subprogram);
  void index(File& file);
  double condition(NcCursor& cursor);
  void expect_end(NcCursor& cursor);
  void turn();
  bool advance(std::string_view& line);
  void count_line();
  File& file() { return *frames_.back().file; }
  std::vector<Loop>& loops() { return frames_.back().loops; }

  File program_;
  std::map<std::string, File> files_;
  std::vector<std::filesystem::path> folders_;
  double max_turns_, turns_ = 0;
  NcPlace& place_;
  NcParameters& parameters_;
  Progress progress_;
  double again_ = 0;         // number of lines read again
  std::uint64_t lines_ = 0;  // number of lines read
  std::vector<Frame> frames_;
  bool used_ = false;
  NcSource::Mark line_mark_;  // position of the last line from advance()
};

}  // namespace riffler::nc
