// Control structures, jumps and subprograms of Sinumerik programs.
#include <algorithm>
#include <cmath>
#include <string>
#include <system_error>
#include <utility>

#include "base/io.hpp"
#include "base/path_text.hpp"
#include "nc/limits.hpp"
#include "nc/read/sinumerik_interpreter.hpp"

namespace riffler::nc {

namespace {

constexpr std::size_t kDeepestRoutine = 60, kMaxRepetitions = 60;
/// Largest number of files in the folders searched for subprograms.
constexpr std::size_t kMaxFiles = 10'000;

}  // namespace

void SinumerikInterpreter::count_turn() {
  // Few turns of many blocks take as long as many turns of few.
  constexpr double kBlocksAtLeast = 1e6;
  if (++turns_ > max_turns_ || executed_ > std::max(kBlocksAtLeast, max_turns_ * kLinesOfTurn))
    place_.fail(std::string("the program jumps more than ") + std::to_string(static_cast<long long>(max_turns_)) +
                " times: it seems endless; option max_turns allows more");
}

void SinumerikInterpreter::go(std::size_t block) {
  count_turn();
  calls_.back().next = block;
}

// --- Structures ---

bool SinumerikInterpreter::execute_structure(const SinumerikBlock& block, SinumerikCursor& cursor) {
  using enum SinumerikKeyword;
  if (block.keyword == None) return false;
  cursor.name();
  const std::size_t behind = block.partner + 1;
  switch (block.keyword) {
    case If:
      if (!values_.condition(cursor)) go(behind);
      break;
    case Else:
      go(behind);
      break;
    case While:
      if (!values_.condition(cursor)) go(behind);
      break;
    case EndWhile:
    case EndLoop:
      go(block.partner);
      break;
    case For:
      for_loop(cursor, true);
      return true;
    case EndFor: {
      const SinumerikBlock& first = calls_.back().routine->blocks[block.partner];
      SinumerikCursor again(first.text, place_);
      again.name();
      for_loop(again, false);
      break;
    }
    case Until:
      if (!values_.condition(cursor)) go(behind);
      break;
    default:
      break;
  }
  cursor.expect_end();
  return true;
}

/// FOR variable = first TO last: increments the variable by 1.
void SinumerikInterpreter::for_loop(SinumerikCursor& cursor, bool first) {
  const std::string variable = values_.element(cursor.name(), cursor);
  if (!cursor.take_if("=")) cursor.fail("FOR without =: FOR variable = first TO last");
  const double begin = values_.value(cursor, "FOR");
  if (!cursor.take_word("TO")) cursor.fail("FOR without TO: FOR variable = first TO last");
  double now = begin;
  if (!first) {
    SinumerikCursor name(variable, place_);
    now = values_.value(name, variable) + 1;
  }
  values_.assign(variable, now);
  const double last = values_.value(cursor, "TO");
  cursor.expect_end();
  Call& here = calls_.back();
  const std::vector<SinumerikBlock>& blocks = here.routine->blocks;
  const std::size_t at = here.next - 1;
  const bool goes_on = now <= last;
  if (first && !goes_on) go(blocks[at].partner + 1);
  if (!first && goes_on) go(blocks[at].partner + 1);
}

// --- Jumps ---

bool SinumerikInterpreter::execute_jump(const std::string& word, SinumerikCursor& cursor) {
  if (word == "IF") {
    const bool holds = values_.condition(cursor);
    const std::string way = cursor.name();
    if (!way.starts_with("GOTO")) cursor.fail("IF without a jump");
    jump(way, cursor, holds);
  } else if (word.starts_with("GOTO")) {
    jump(word, cursor, true);
  } else if (word == "CASE") {
    choose(cursor);
  } else if (word == "REPEAT" || word == "REPEATB") {
    repeat(cursor, word == "REPEATB");
  } else if (word == "ENDLABEL") {
    return true;
  } else {
    return false;
  }
  return true;
}

/// Reads the label; `taken`: whether the jump is executed.
void SinumerikInterpreter::jump(const std::string& way, SinumerikCursor& cursor, bool taken) {
  if (way == "GOTOS") {
    if (taken) go(0);
    return cursor.expect_end();
  }
  if (way != "GOTO" && way != "GOTOF" && way != "GOTOB" && way != "GOTOC")
    cursor.fail(way + " is not known: GOTO, GOTOF, GOTOB and GOTOC are");
  std::string label;
  if (cursor.take_if(":")) {
    label = std::string(":") + cursor.digits();
  } else if (cursor.peek() == '"') {
    label = sinumerik_name(cursor.quoted());
  } else {
    label = cursor.name();
    if (const auto text = values_.text(label)) label = sinumerik_name(*text);
  }
  if (label.empty()) cursor.fail_unexpected();
  // The next branch of CASE may follow.
  if (!taken) return;
  const std::size_t block = find_label(label, way != "GOTOB", way != "GOTOF");
  if (block < calls_.back().routine->blocks.size()) return go(block);
  if (way != "GOTOC")
    place_.fail("there is no label " + label +
                (way == "GOTOB"   ? " before"
                 : way == "GOTOF" ? " after"
                                  : "") +
                " this block");
}

/// The block of a label, first searching forward, then backward; the number of blocks if there is none.
std::size_t SinumerikInterpreter::find_label(const std::string& label, bool forward, bool backward) const {
  const Call& here = calls_.back();
  const auto found = here.routine->labels.find(label);
  const std::size_t none = here.routine->blocks.size();
  if (found == here.routine->labels.end()) return none;
  const std::vector<std::size_t>& at = found->second;
  const auto next = std::ranges::lower_bound(at, here.next);
  if (forward && next != at.end()) return std::min(*next, none);
  if (backward && next != at.begin()) return *std::prev(next);
  return none;
}

/// CASE (value) OF 1 GOTOF A 2 GOTOF B DEFAULT GOTOF C.
void SinumerikInterpreter::choose(SinumerikCursor& cursor) {
  const double value = values_.value(cursor, "CASE");
  if (!cursor.take_word("OF")) cursor.fail("CASE without OF");
  while (cursor.peek() != '\0') {
    const bool otherwise = cursor.take_word("DEFAULT");
    const bool holds = otherwise || values_.value(cursor, "CASE") == value;
    const std::string way = cursor.name();
    if (!way.starts_with("GOTO")) cursor.fail("CASE without a jump");
    jump(way, cursor, holds);
    if (holds) return;
  }
}

/// REPEAT A P=n: from the label to here, or to ENDLABEL; REPEAT A B P=n: from A to the end of B; REPEATB A P=n: the
/// block A.
void SinumerikInterpreter::repeat(SinumerikCursor& cursor, bool one_block) {
  const auto times_follow = [&] { return cursor.peek() == 'P' && cursor.at_address(); };
  const auto label_block = [&](const std::string& label) {
    const std::size_t block = find_label(label, true, true);
    if (block >= calls_.back().routine->blocks.size()) place_.fail("there is no label " + label);
    return block;
  };
  const std::string first = cursor.name();
  if (first.empty()) cursor.fail_unexpected();
  Call& here = calls_.back();
  Repetition part{label_block(first), here.next - 1, here.next, 1};
  if (part.begin < here.next && here.routine->labels.at(first).size() > 1) part.begin = find_label(first, false, true);
  if (one_block) part.end = part.begin + 1;
  if (!one_block && cursor.peek() != '\0' && !times_follow()) {
    part.end = label_block(cursor.name()) + 1;
  } else if (!one_block) {
    const auto ends = here.routine->labels.find("ENDLABEL");
    if (ends != here.routine->labels.end())
      if (const auto end = std::ranges::upper_bound(ends->second, part.begin); end != ends->second.end())
        part.end = *end;
  }
  if (times_follow()) {
    cursor.take();
    cursor.take_if("=");
    part.left = values_.whole(cursor, "P");
  }
  cursor.expect_end();
  if (part.begin >= part.end) place_.fail("REPEAT of a part that ends before it begins");
  if (part.left < 1) return;
  if (here.repetitions.size() >= kMaxRepetitions) place_.fail("REPEAT is nested too deeply");
  here.repetitions.push_back(part);
  go(part.begin);
}

void SinumerikInterpreter::end_repetitions() {
  Call& here = calls_.back();
  while (!here.repetitions.empty()) {
    Repetition& part = here.repetitions.back();
    if (here.next >= part.begin && here.next < part.end) return;
    if (here.next == part.end) {
      if (--part.left > 0) return go(part.begin);
      here.next = part.back;
    }
    here.repetitions.pop_back();  // finished, or left by a jump
  }
}

// --- Subprograms ---

void SinumerikInterpreter::call(const std::string& name, SinumerikCursor& cursor, int times) {
  const auto routine = find_routine(name);
  if (!routine) {
    if (!skip_unknown_)
      place_.fail("unknown statement or subprogram " + name + ": correct it, or put the file " + name +
                  ".SPF into the program's folder (or that of option subroutines)");
    note("coordinates", name + " was skipped, a subprogram that is not there: where the tool is after it is not known");
    cursor.skip_all();
    lose_place();
    rows_->at_machine({true, 0, false, turning_ * speed_, tool_, calls_.front().line});
    return;
  }
  if (times > 0) enter(routine, cursor, times);
}

void SinumerikInterpreter::enter(const std::shared_ptr<const SinumerikRoutine>& routine, SinumerikCursor& cursor,
                                 int times) {
  if (calls_.size() >= kDeepestRoutine) place_.fail("subprograms are nested too deeply");
  count_turn();
  // Arguments are evaluated in the caller.
  bind(*routine, cursor);
  SinumerikCursor ahead = cursor;
  if (ahead.peek() == 'P' && ahead.at_address()) {
    ahead.take();
    ahead.take_if("=");
    times = values_.whole(ahead, "P");
    cursor = ahead;
  }
  cursor.expect_end();
  Call made{routine};
  made.line = calls_.front().line, made.left = times - 1;
  calls_.push_back(std::move(made));
}

/// Defines the parameters of PROC from the arguments in brackets that come next. Omitted ones get the default of PROC,
/// or 0.
void SinumerikInterpreter::bind(const SinumerikRoutine& routine, SinumerikCursor& cursor) {
  Arguments given;
  if (cursor.take_if("(")) given = arguments(cursor);
  const bool main = calls_.size() == 1 && calls_.front().routine.get() == &routine;
  if (!main) values_.enter();
  const NcPlace caller = place_;
  std::size_t count = 0;
  if (!routine.blocks.empty()) {
    place_ = {routine.file, routine.blocks[0].line, routine.blocks[0].text};
    SinumerikCursor header(routine.blocks[0].text, place_);
    if (header.take_word("PROC") && (header.name(), header.take_if("(")) && !header.take_if(")")) {
      if (main)
        place_.fail("a subprogram with parameters: read the program that calls it, with this file in its folder");
      do {
        std::string type = header.name();
        if (type == "VAR")
          place_.fail("a parameter that the subprogram changes (VAR) is not read: assign an R parameter instead");
        const auto kind = SinumerikValues::kind_of(type);
        if (!kind || *kind == SinumerikValues::Kind::Text)
          place_.fail("a parameter of type " + type + " is not read: REAL, INT, BOOL and CHAR are");
        const std::string name = header.name();
        std::optional<double> value = 0;
        if (header.take_if("=")) value = values_.expression(header);
        if (count < given.size() && given[count]) value = given[count];
        values_.define(name, *kind, value);
        ++count;
      } while (header.take_if(","));
    }
  }
  place_ = caller;
  if (given.size() > count)
    place_.fail(routine.name + std::string(" takes ") + std::to_string(count) + std::string(" arguments, ") +
                std::to_string(given.size()) + " are given");
}

void SinumerikInterpreter::leave() {
  Call& here = calls_.back();
  if (here.left > 0) {
    --here.left, here.next = 0, here.repetitions.clear();
    count_turn();
    return;
  }
  calls_.pop_back();
  values_.leave();
}

std::shared_ptr<const SinumerikRoutine> SinumerikInterpreter::find_routine(const std::string& name) {
  if (const auto found = routines_.find(name); found != routines_.end()) return found->second;
  if (!files_) index_folders();
  const auto file = files_->find(name);
  if (file == files_->end()) return nullptr;
  const std::vector<std::uint8_t> bytes = base::read_file(file->second);
  auto text = std::make_shared<const std::string>(bytes.begin(), bytes.end());
  NcPlace place{base::file_name(file->second), 0, {}};
  std::vector<SinumerikRoutine> all = sinumerik_routines(*text, place);
  SinumerikRoutine& first = all.front();
  first.text = text;
  return routines_[name] = std::make_shared<const SinumerikRoutine>(std::move(first));
}

/// Indexes the subprogram files in the program's folder and the folder of the option.
void SinumerikInterpreter::index_folders() {
  files_.emplace();
  for (const std::filesystem::path& folder : folders_) {
    std::error_code error;
    std::size_t count = 0;
    for (std::filesystem::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
      if (++count > kMaxFiles) break;
      const std::string file = base::file_name(at->path()), name = sinumerik_name(file);
      std::string upper;
      for (const char c : file) upper += NcCursor::upper(c);
      if (!upper.ends_with("SPF") && !upper.ends_with("MPF")) continue;
      // If two names differ only in case, every system picks the same one.
      const auto [known, fresh] = files_->emplace(name, at->path());
      if (!fresh && known->second.parent_path() == at->path().parent_path())
        known->second = std::min(known->second, at->path());
    }
  }
}

}  // namespace riffler::nc
