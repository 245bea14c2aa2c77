#include "nc/read/interpreter.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/path_text.hpp"
#include "nc/limits.hpp"
#include "nc/machine/header.hpp"
#include "nc/machine/machines.hpp"
#include "nc/machine/post_options.hpp"

namespace riffler::nc {

NcInterpreter::NcInterpreter(std::unique_ptr<NcSource> source, const std::filesystem::path& folder,
                             const ReadOptions& options)
    : parameters_(*this), source_(source->name()) {
  if (!folder.empty()) given_.folders.push_back(folder);
  take_options(options);
  if (given_.check_header) check_header(*source, rows_->machine());
  flow_ = std::make_unique<NcControlFlow>(std::move(source), given_.folders, given_.max_turns, place_, parameters_,
                                          options.progress);
  words_ = std::make_unique<NcWords>(rows_->machine().axes(), place_, given_.skip_unknown ? &skipped_here_ : nullptr);
  use_positions();
  frame_ = frame_of_parameters();
  rows_->set_frame(frame_);
  at_ = frame_.to_program({});
}

void NcInterpreter::take_options(const ReadOptions& options) {
  machine_ = options.machine, machine_options_ = options.options;
  tcp_given_ = machine_options_.contains("tcp");
  OptionReader taken(options.options, "machine " + options.machine);
  std::unique_ptr<Machine> machine = make_machine(options.machine, taken);
  const double chord = taken.positive("chord_tolerance").value_or(0.002);
  const std::optional<double> axis = taken.positive("axis_tolerance");
  take_post_options(taken);  // reading and writing share these options
  given_.block_delete = taken.flag("block_delete", true);
  given_.check_header = taken.word("header", {"check", "ignore"}, "check") == "check";
  given_.max_turns = taken.positive("max_turns").value_or(1e6);
  given_.skip_unknown = taken.word("unknown", {"error", "skip"}, "error") == "skip";
  given_.compensation = take_compensation_rule(taken);
  diameters_.take(options.options, taken);
  if (const std::string folder = taken.path("subroutines"); !folder.empty())
    given_.folders.push_back(base::text_path(folder));
  given_.parameters = taken.path("parameters");
  given_.units = taken.given("units");
  if (taken.word("units", {"mm", "inch"}, "mm") == "inch") modes_.unit = kInch;
  given_.arc_miss = taken.positive("arc_tolerance").value_or(kArcMiss);
  take_start(taken);
  take_positions(taken);
  taken.done();
  if (chord < 1e-6) throw std::invalid_argument("option chord_tolerance must be at least 1e-6 mm");
  if (given_.arc_miss > kMaxArcMiss) throw std::invalid_argument("option arc_tolerance must be at most 1 mm");
  if (axis && *axis < 1e-6) throw std::invalid_argument("option axis_tolerance must be at least 1e-6 rad");
  rows_ = std::make_unique<NcRows>(std::move(machine), chord, axis, place_);
  make_compensation();
}

/// What holds on a control before the program says otherwise.
void NcInterpreter::take_start(OptionReader& taken) {
  modes_.absolute_centre = taken.word("arc_centres", {"relative", "absolute"}, "relative") == "absolute";
  given_.feed = taken.positive("first_feed");
  given_.motion_name = taken.word("first_motion", {"none", "G0", "G1"}, "none");
  if (given_.motion_name != "none") given_.motion = given_.motion_name == "G0" ? 0 : 10;
  if (given_.feed && !(*given_.feed <= kMaxFeed)) throw std::invalid_argument("option first_feed is out of range");
}

bool NcInterpreter::step() {
  if (execute_line()) return true;
  compensation_->off();
  rows_->release(true);
  return false;
}

bool NcInterpreter::execute_line() {
  std::string_view line;
  // After an end in a subroutine, or one that another branch may avoid, the rest is not checked.
  if (ended_ && (flow_->depth() > 0 || flow_->is_used())) return false;
  if (!flow_->next(line)) return false;
  NcCursor cursor(line, place_);
  if (ended_) return !ended(line);
  if (executes(cursor)) block(cursor);
  return true;
}

/// Whether the line, after its / and N, holds a block.
bool NcInterpreter::executes(NcCursor& cursor) {
  const char c = cursor.peek();
  if (c == '\0') return false;
  if (c == '%') {
    percent();
    return false;
  }
  if (c == ':') {  // ISO 6983's alternative letter for O and N
    cursor.take();
    if (cursor.at_number()) cursor.number(':');
  }
  if (!started_ && cursor.take_word("<O")) return false;  // program number on some controls
  if (c == '/') {
    if (given_.block_delete) return false;
    cursor.take();
  }
  if (cursor.peek() == 'N') {
    cursor.take();
    if (!(std::abs(cursor.number('N')) <= kMaxNumber)) place_.fail("N is out of range");
  }
  return cursor.peek() != '\0';
}

/// Whether `line`, which follows the end of the program, is the last to examine: code after it is not reached, as in
/// LinuxCNC, but subroutines may follow.
bool NcInterpreter::ended(std::string_view line) {
  if (NcControlFlow::begins_subroutine(line)) return true;
  NcCursor cursor(line, place_);
  if (!executes(cursor)) return false;
  note("end", "text after the end of the program is not read");
  return true;
}

/// The rest of the line is the name of a tape or file.
void NcInterpreter::percent() {
  // The first % frames the start, the second the end.
  if (!started_ && !percent_)
    percent_ = true;
  else
    ended_ = true;
}

void NcInterpreter::block(NcCursor& cursor) {
  const bool first = !started_;
  started_ = true;
  if (cursor.peek() == 'O') {
    cursor.take();
    if (flow_->execute(cursor)) return leave_saved_states();
    if (!first)
      place_.fail(
          "O with only a number is the program number, before everything else, or a subprogram for M98, after the "
          "program's end");
  }
  words_->read(cursor, parameters_);
  for (const std::string& word : skipped_here_) {
    if (words_->lost_axes())
      note("coordinates",
           word + (word.size() == 1 ? " was skipped, an axis of the program" : " was skipped, with its axis words"));
    else
      note("skipped", word);
  }
  skipped_here_.clear();
  parameters_.apply();
  execute();
}

/// In LinuxCNC's order (its manual, "G-Code Order of Execution"), except that G20 and G21 apply to an F in the same
/// block.
void NcInterpreter::execute() {
  if (words_->only_moves() && !words_->has('H') && !words_->has('D')) {
    feed_and_speed();
    if (words_->has('T')) next_tool_ = words_->whole('T');
    motion();
  } else {
    units_and_feed_mode();
    feed_and_speed();
    spindle();
    signals();
    tool();
    states();
    kinematics();
    dwell();
    modes();
    tool_length();
    select_system(words_->code(NcGroup::WorkOffset));
    paths();
    non_modal();
    motion();
    subprograms();
    stop();
  }
  words_->check_all_used();
}

void NcInterpreter::note(const char* kind, const std::string& message) {
  notes_.add(kind, flow_->program_line(), message);
}

}  // namespace riffler::nc
