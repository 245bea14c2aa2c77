#include "nc/read/sinumerik_interpreter.hpp"

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <utility>

#include "base/path_text.hpp"
#include "nc/limits.hpp"
#include "nc/machine/header.hpp"
#include "nc/machine/machines.hpp"
#include "nc/machine/post_options.hpp"
#include "nc/read/sinumerik_reader.hpp"

namespace riffler::nc {

Program parse_sinumerik(std::string_view text, const std::string& file, const ReadOptions& options,
                        const std::filesystem::path& folder) {
  return SinumerikInterpreter(text, file, folder, options).run();
}

SinumerikInterpreter::SinumerikInterpreter(std::string_view text, const std::string& file,
                                           const std::filesystem::path& folder, const ReadOptions& options)
    : place_{file, 0, {}}, values_(place_), source_(file), progress_(options.progress) {
  if (!folder.empty()) folders_.push_back(folder);
  take_options(options);
  NcSource source(text, file);
  if (check_header_) check_header(source, rows_->machine());
  std::shared_ptr<const SinumerikRoutine> main;
  for (SinumerikRoutine& routine : sinumerik_routines(text, place_)) {
    const auto made = std::make_shared<const SinumerikRoutine>(std::move(routine));
    if (!main) main = made;
    routines_.emplace(made->name, made);
    for (const SinumerikBlock& block : made->blocks) {
      SinumerikCursor cursor(block.text, place_);
      const bool changes = cursor.take_if("T") || cursor.take_if("t");
      const std::string digits = changes ? cursor.digits() : "";
      if (!digits.empty() && digits.size() < 9) last_tool_ = std::max(last_tool_, std::stoi(digits));
    }
  }
  calls_.push_back({main});
}

void SinumerikInterpreter::take_options(const ReadOptions& options) {
  OptionReader taken(options.options, "machine " + options.machine);
  std::unique_ptr<Machine> machine = make_machine(options.machine, taken);
  const double chord = taken.positive("chord_tolerance").value_or(0.002);
  const std::optional<double> axis = taken.positive("axis_tolerance");
  take_post_options(taken);                                    // reading and writing share these options
  arc_miss_ = taken.positive("arc_tolerance").value_or(0.01);  // the control's default (MD21000)
  block_delete_ = taken.flag("block_delete", false);
  check_header_ = taken.word("header", {"check", "ignore"}, "check") == "check";
  max_turns_ = taken.positive("max_turns").value_or(1e6);
  skip_unknown_ = taken.word("unknown", {"error", "skip"}, "error") == "skip";
  ignore_compensation_ = taken.word("cutter_compensation", {"error", "ignore"}, "error") == "ignore";
  if (const std::string folder = taken.path("subroutines"); !folder.empty())
    folders_.push_back(base::text_path(folder));
  units_given_ = taken.given("units");
  if (taken.word("units", {"mm", "inch"}, "mm") == "inch") basic_unit_ = unit_ = feed_unit_ = kInch;
  taken.done();
  if (machine->joint_words())
    throw std::invalid_argument("machine " + machine->name() +
                                ": code for a Sinumerik control has tip coordinates (TRAORI): tcp must not be False");
  if (arc_miss_ > kMaxArcMiss) throw std::invalid_argument("option arc_tolerance must be at most 1 mm");
  if (chord < 1e-6) throw std::invalid_argument("option chord_tolerance must be at least 1e-6 mm");
  if (axis && *axis < 1e-6) throw std::invalid_argument("option axis_tolerance must be at least 1e-6 rad");
  rows_ = std::make_unique<NcRows>(std::move(machine), chord, axis, place_);
}

// --- The order of blocks ---

Program SinumerikInterpreter::run() {
  constexpr std::uint64_t kBlocksAReport = 1024;
  for (std::uint64_t n = 0; step(); ++n) {
    if (n % kBlocksAReport == 0)
      base::report(progress_, static_cast<double>(calls_.front().next) /
                                  static_cast<double>(std::max<std::size_t>(calls_.front().routine->blocks.size(), 1)));
    flush();
  }
  rows_->release(true);
  flush();
  program_.provenance = notes_.provenance(source_), program_.notes = notes_.notes();
  return std::move(program_);
}

/// Executes one block; false at the end.
bool SinumerikInterpreter::step() {
  if (ended_) return false;
  end_repetitions();
  Call& here = calls_.back();
  if (here.next >= here.routine->blocks.size()) {
    if (calls_.size() == 1) return false;
    leave();
    return true;
  }
  const SinumerikBlock& block = here.routine->blocks[here.next++];
  place_.file = here.routine->file, place_.line = block.line, place_.text = block.text;
  if (calls_.size() == 1) here.line = block.line;
  ++executed_;
  if (!(block.optional && block_delete_)) execute(block);
  return true;
}

void SinumerikInterpreter::execute(const SinumerikBlock& block) {
  SinumerikCursor cursor(block.text, place_);
  if (execute_structure(block, cursor)) return;
  SinumerikCursor ahead = cursor;
  const std::string word = ahead.name();
  if (word.size() > 1 && word[0] == 'L' && cursor.at_address() && ahead.peek() == '(') return call(word, ahead, 1);
  if (cursor.at_address() || cursor.peek() == '\0') return words_of(cursor);
  if (execute_jump(word, ahead) || execute_statement(word, ahead)) return;
  words_of(cursor);
}

/// Statements that must be alone in their block.
bool SinumerikInterpreter::execute_statement(const std::string& word, SinumerikCursor& cursor) {
  if (word == "DEF") {
    define(cursor);
    return true;
  }
  if (word == "PROC") {
    if (calls_.size() == 1) {
      const SinumerikRoutine& routine = *calls_.front().routine;
      SinumerikCursor none("", place_);
      bind(routine, none);
    }
    return true;
  }
  if (word == "EXTERN" || word == "GROUP_BEGIN" || word == "GROUP_END") return true;
  if (word == "MCALL") {
    modal_call(cursor);
    return true;
  }
  if (word == "CALL" || word == "PCALL" || word == "EXTCALL") {
    const bool bracket = word == "EXTCALL" && cursor.take_if("(");
    if (cursor.peek() != '"') place_.fail(word + " is read with the name in quotes: " + word + " \"NAME\"");
    const std::string name = sinumerik_name(cursor.quoted());
    if (bracket && !cursor.take_if(")")) cursor.fail("a bracket that is not closed");
    call(name, cursor, 1);
    return true;
  }
  return execute_frame(word, cursor) || execute_cycle(word, cursor);
}

void SinumerikInterpreter::words_of(SinumerikCursor& cursor) {
  by_machine_ = homes_ = dwells_ = bounds_ = taps_ = returns_ = false;
  SinumerikWords words;
  const std::size_t depth = calls_.size();
  words.read(cursor, values_, [&](const std::string& name, SinumerikCursor& at) { named(name, at, words); });
  if (calls_.size() != depth) return;  // a subprogram call, which must be alone in its block
  execute_words(words);
}

void SinumerikInterpreter::execute_words(SinumerikWords& words) {
  take_codes(words);
  take_feed(words);
  take_tool(words);
  begin_functions(words);
  motion(words);
  end_functions(words);
  if (words.call) {
    const int times = words.times.value_or(1);
    SinumerikCursor none("", place_);
    call(std::string("L") + std::to_string(*words.call), none, times);
  } else if (words.times) {
    place_.fail("P belongs to the call of a subprogram");
  }
  if (!returns_) return;
  if (calls_.size() == 1)
    ended_ = true;
  else
    leave();
}

// --- Notes ---

void SinumerikInterpreter::flush() {
  std::vector<Move>& pending = rows_->pending();
  if (program_.size() + pending.size() + rows_->held() > kMaxRows) place_.fail("more rows than can be stored");
  for (const Move& move : pending) program_.append(move);
  pending.clear();
}

void SinumerikInterpreter::note(const char* kind, const std::string& message) {
  notes_.add(kind, calls_.empty() ? place_.line : calls_.front().line, message);
}

void SinumerikInterpreter::note_once(int key, const char* kind, const std::string& message) {
  if (noted_.insert(key).second) note(kind, message);
}

}  // namespace riffler::nc
