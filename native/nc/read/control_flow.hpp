// Which line of NC code comes next: O-words (subroutines, loops, branches), subprograms by M98, files of subroutines.
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
  /// Subroutines that the program does not hold are sought as name.ngc in `folders`. After `max_turns` turns of loops
  /// and calls, or where they read lines again and again without end, the program counts as endless. `progress` hears
  /// of lines that are passed over, too. Keeps `place`, in which it says where it is, and `parameters`.
  NcControlFlow(std::unique_ptr<NcSource> program, std::vector<std::filesystem::path> folders, double max_turns,
                NcPlace& place, NcParameters& parameters, Progress progress = {});

  /// The next line in the order of execution; false at the end. FormatError for a file that ends within a subroutine.
  bool next(std::string_view& line);

  /// What follows "O" in a block. False: it is no more than a number.
  bool execute(NcCursor& cursor);

  /// M98 and M99; false where M99 has nothing to return to.
  void call_subprogram(int number, int repeats);
  bool end_subprogram();

  /// Whether `line` begins subroutines, which may stand after the end of the program.
  static bool begins_subroutine(std::string_view line);
  /// The line of the program (not of a file of subroutines) that is being executed.
  int program_line() const;
  /// How many subroutines and subprograms it is in.
  std::size_t depth() const { return frames_.size() - 1; }
  /// Whether an O-word has been executed: then what follows M2 may have been meant for other turns.
  bool is_used() const { return used_; }

 private:
  struct File {
    std::unique_ptr<NcSource> source;
    std::map<std::string, NcSource::Mark> subs, subprograms;
    bool is_indexed = false;
    int furthest = 0;  // line that was read
  };
  struct Loop {
    std::string label;
    NcKeyword kind;
    NcSource::Mark again;  // the line of while, the line after do and repeat
    double left = 0;       // turns of repeat
  };
  struct Frame {
    File* file;
    std::string label;           // of the subroutine
    bool is_subprogram = false;  // by M98
    int repeats = 1;
    NcSource::Mark first, back{};  // where it begins, and where its caller goes on
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
  /// Reads on to the line of `label` with one of `keywords`: which, and the text after it.
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
  double again_ = 0;         // lines that were read not for the first time
  std::uint64_t lines_ = 0;  // in all
  std::vector<Frame> frames_;
  bool used_ = false;
  NcSource::Mark line_mark_;  // of the line that advance() gave last
};

}  // namespace riffler::nc
