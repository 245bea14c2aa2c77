#include "nc/read/control_flow.hpp"

#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

#include "base/path_text.hpp"
#include "nc/limits.hpp"
#include "nc/read/expression.hpp"

namespace riffler::nc {

namespace fs = std::filesystem;

namespace {

/// As in LinuxCNC.
constexpr std::size_t kDeepestCall = 10;

/// "O100" and "O<name>".
std::string show(const std::string& label) {
  return NcCursor::is_digit(label[0]) ? "O" + label : "O<" + label + ">";
}

}  // namespace

NcControlFlow::NcControlFlow(std::unique_ptr<NcSource> program, std::vector<fs::path> folders, double max_turns,
                             NcPlace& place, NcParameters& parameters, Progress progress)
    : folders_(std::move(folders)),
      max_turns_(max_turns),
      place_(place),
      parameters_(parameters),
      progress_(std::move(progress)) {
  program_.source = std::move(program);
  frames_.push_back({&program_, {}, false, 1, {}});
  place_.file = program_.source->name();
}

bool NcControlFlow::advance(std::string_view& line) {
  NcSource& source = *file().source;
  line_mark_ = source.mark();
  if (!source.next(line)) return false;
  place_.line = source.line(), place_.text = line;
  count_line();
  return true;
}

/// A turn may skip a million lines, so the number of turns alone is not a bound.
void NcControlFlow::count_line() {
  constexpr std::uint64_t kLinesAReport = 4096;
  if (place_.line > file().furthest)
    file().furthest = place_.line;
  else if (++again_ > kLinesOfTurn * max_turns_)
    place_.fail("an endless loop? Its turns read more lines than option max_turns allows, " +
                std::to_string(static_cast<int>(kLinesOfTurn)) + " each");
  if (++lines_ % kLinesAReport == 0) base::report(progress_, program_.source->share());
}

bool NcControlFlow::next(std::string_view& line) {
  if (advance(line)) return true;
  if (frames_.size() > 1) place_.fail("the file ends within subroutine " + show(frames_.back().label));
  return false;
}

int NcControlFlow::program_line() const {
  for (std::size_t k = 0; k + 1 < frames_.size(); ++k)
    if (frames_[k].file == &program_ && frames_[k + 1].file != &program_) return frames_[k + 1].back.line;
  return place_.line;
}

bool NcControlFlow::begins_subroutine(std::string_view line) {
  const std::optional<NcOLine> o = nc_o_line(line);
  return o && (o->keyword == NcKeyword::Sub || o->keyword == NcKeyword::None);
}

void NcControlFlow::turn() {
  if (++turns_ > max_turns_) place_.fail("an endless loop? More turns of loops and calls than option max_turns allows");
}

void NcControlFlow::expect_end(NcCursor& cursor) {
  if (cursor.peek() != '\0') place_.fail("text after an O-word: an O-word must be alone on its line");
}

double NcControlFlow::condition(NcCursor& cursor) {
  if (cursor.peek() != '[') place_.fail("expected a value in brackets after an O-word");
  const double value = nc_value(cursor, parameters_, place_, '[');
  expect_end(cursor);
  return value;
}

bool NcControlFlow::execute(NcCursor& cursor) {
  std::string label;
  const char c = cursor.peek();
  if (c == '<') {
    cursor.take();
    label = cursor.name();
  } else if (NcCursor::is_digit(c) || c == '#' || c == '[') {
    const double number = nc_value(cursor, parameters_, place_, 'O');
    if (!(number >= 0 && number <= kMaxNumber && number == std::round(number))) place_.fail("O must be a whole number");
    label = std::to_string(static_cast<int>(number));
  } else {
    place_.fail("expected a number or <name> after O");
  }
  const std::string word = cursor.letters();
  const std::optional<NcKeyword> keyword = nc_keyword(word);
  if (!keyword) place_.fail("unknown word after " + show(label) + ": " + word);
  used_ = used_ || *keyword != NcKeyword::None;
  switch (*keyword) {
    case NcKeyword::None:
      return false;
    case NcKeyword::Sub:
    case NcKeyword::EndSub:
    case NcKeyword::Call:
    case NcKeyword::Return:
      subroutine(label, *keyword, cursor);
      return true;
    case NcKeyword::If:
    case NcKeyword::ElseIf:
    case NcKeyword::Else:
    case NcKeyword::EndIf:
      branch(label, *keyword, cursor);
      return true;
    default:
      loop(label, *keyword, cursor);
      return true;
  }
}

// --- Subroutines ---

void NcControlFlow::subroutine(const std::string& label, NcKeyword keyword, NcCursor& cursor) {
  std::vector<double> values;
  while (cursor.peek() == '[') values.push_back(nc_value(cursor, parameters_, place_, '['));
  expect_end(cursor);
  switch (keyword) {
    case NcKeyword::Sub:
      // Reached without a call: skip the subroutine.
      if (frames_.size() > 1) place_.fail("a subroutine within subroutine " + show(frames_.back().label));
      file().subs.emplace(label, file().source->mark());
      skip(label, {NcKeyword::EndSub});
      return;
    case NcKeyword::Call:
      if (values.size() > NcParameters::kArguments) place_.fail("more than 30 arguments");
      call(label, values);
      return;
    default:
      // A return may have any label.
      if (frames_.size() == 1 || frames_.back().is_subprogram ||
          (keyword == NcKeyword::EndSub && frames_.back().label != label))
        place_.fail("not within subroutine " + show(label));
      if (values.size() > 1) place_.fail("more than one value to return");
      leave(values.empty() ? std::nullopt : std::optional(values[0]));
  }
}

void NcControlFlow::index(File& file) {
  if (std::exchange(file.is_indexed, true)) return;
  const NcSource::Mark here = file.source->mark();
  file.source->go({});
  std::string_view line;
  while (file.source->next(line)) {
    const std::optional<NcOLine> o = nc_o_line(line);
    if (!o) continue;
    if (o->keyword == NcKeyword::Sub) file.subs.emplace(o->label, file.source->mark());
    if (o->keyword == NcKeyword::None) file.subprograms.emplace(o->label, file.source->mark());
  }
  file.source->go(here);
}

/// Searches the current file, the program, then a file of its own.
std::pair<NcControlFlow::File*, NcSource::Mark> NcControlFlow::find(const std::string& label, bool subprogram) {
  const auto look = [&](File& file) -> std::optional<NcSource::Mark> {
    const auto& all = subprogram ? file.subprograms : file.subs;
    auto found = all.find(label);
    if (found == all.end()) {
      index(file);
      found = all.find(label);
    }
    return found == all.end() ? std::nullopt : std::optional(found->second);
  };
  for (File* file : {&file(), &program_})
    if (const auto mark = look(*file)) return {file, *mark};
  // A name may only be part of a file's name.
  const bool is_plain = label.find_first_of("/\\") == label.npos && label[0] != '.';
  for (const fs::path& folder : folders_) {
    const fs::path path = folder / base::text_path(label + ".ngc");
    std::error_code code;
    if (!is_plain || !fs::is_regular_file(path, code)) continue;
    File& file = files_[base::path_text(path)];
    if (!file.source) file.source = std::make_unique<NcSource>(path);
    if (const auto mark = look(file)) return {&file, *mark};
    place_.fail(file.source->name() + " holds no subroutine " + show(label));
  }
  place_.fail("no subroutine " + show(label) + ": neither in the program, nor as " + label +
              ".ngc in its folder or that of option subroutines");
}

void NcControlFlow::call(const std::string& label, const std::vector<double>& arguments) {
  turn();
  if (frames_.size() > kDeepestCall) place_.fail("calls nested more than 10 deep");
  const auto [file, mark] = find(label, false);
  Frame frame{file, label, false, 1, mark, frames_.back().file->source->mark()};
  parameters_.enter(arguments);
  frames_.push_back(std::move(frame));
  file->source->go(mark);
  place_.file = file->source->name();
}

void NcControlFlow::leave(std::optional<double> value) {
  if (!frames_.back().is_subprogram) parameters_.leave(value);
  const NcSource::Mark back = frames_.back().back;
  frames_.pop_back();
  file().source->go(back);
  place_.file = file().source->name();
}

void NcControlFlow::call_subprogram(int number, int repeats) {
  turn();
  if (frames_.size() > kDeepestCall) place_.fail("calls nested more than 10 deep");
  if (repeats == 0) return;
  const std::string label = std::to_string(number);
  const auto [file, mark] = find(label, true);
  frames_.push_back({file, label, true, repeats, mark, frames_.back().file->source->mark()});
  file->source->go(mark);
  place_.file = file->source->name();
}

bool NcControlFlow::end_subprogram() {
  if (!frames_.back().is_subprogram) return false;
  Frame& frame = frames_.back();
  frame.loops.clear();
  if (--frame.repeats > 0) {
    turn();
    frame.file->source->go(frame.first);
  } else {
    leave(std::nullopt);
  }
  return true;
}

// --- Branches and loops ---

std::pair<NcKeyword, std::string_view> NcControlFlow::skip(const std::string& label,
                                                           std::initializer_list<NcKeyword> keywords) {
  const NcPlace begin{place_.file, place_.line, {}};
  std::string_view line;
  const bool to_end = *keywords.begin() == NcKeyword::EndSub;
  while (advance(line)) {
    const std::optional<NcOLine> o = nc_o_line(line);
    if (!o) continue;
    if (o->label == label && std::find(keywords.begin(), keywords.end(), o->keyword) != keywords.end())
      return {o->keyword, o->rest};
    // Labels of loops and branches are local to their subroutine.
    if (!to_end && o->keyword == NcKeyword::EndSub) break;
  }
  begin.fail(show(label) + " has no end");
}

/// A taken branch stays among the loops until its end, so that unmatched words are detected.
void NcControlFlow::branch(const std::string& label, NcKeyword keyword, NcCursor& cursor) {
  if (keyword == NcKeyword::If) {
    leave_loop(label);
    const NcSource::Mark here = line_mark_;
    bool taken = condition(cursor) != 0;
    while (!taken) {
      const auto [found, rest] = skip(label, {NcKeyword::ElseIf, NcKeyword::Else, NcKeyword::EndIf});
      NcCursor after(rest, place_);
      if (found == NcKeyword::EndIf) return expect_end(after);
      if (found == NcKeyword::Else) expect_end(after);
      taken = found == NcKeyword::Else || condition(after) != 0;
    }
    loops().push_back({label, keyword, here});
    return;
  }
  const Loop* const inside = find_loop(label);
  if (!inside || inside->kind != NcKeyword::If) place_.fail("not within branch " + show(label));
  if (keyword == NcKeyword::EndIf)
    expect_end(cursor);
  else
    skip(label, {NcKeyword::EndIf});  // an ELSE reached by execution ends the branch taken
  leave_loop(label);
}

NcControlFlow::Loop* NcControlFlow::find_loop(const std::string& label) {
  for (Loop& loop : loops())
    if (loop.label == label) return &loop;
  return nullptr;
}

/// Ends the loop and all loops within it.
void NcControlFlow::leave_loop(const std::string& label) {
  if (const Loop* loop = find_loop(label)) loops().erase(loops().begin() + (loop - loops().data()), loops().end());
}

/// At the end of a loop's body.
void NcControlFlow::next_turn(const std::string& label) {
  Loop* loop = find_loop(label);
  loops().erase(loops().begin() + (loop - loops().data()) + 1, loops().end());
  if (loop->kind == NcKeyword::Repeat && loop->left-- < 1) return leave_loop(label);
  turn();
  file().source->go(loop->again);
}

void NcControlFlow::loop(const std::string& label, NcKeyword keyword, NcCursor& cursor) {
  const Loop* const inside = find_loop(label);
  const NcSource::Mark after_line = file().source->mark();
  if (keyword == NcKeyword::While) {
    const bool ends_do = inside && inside->kind == NcKeyword::Do;
    const NcSource::Mark this_line = line_mark_;
    const bool again = condition(cursor) != 0;
    if (again && ends_do) return next_turn(label);
    leave_loop(label);
    if (again) return loops().push_back({label, keyword, this_line});
    if (!ends_do) skip(label, {NcKeyword::EndWhile});
  } else if (keyword == NcKeyword::Do || keyword == NcKeyword::Repeat) {
    double count = 1;
    if (keyword == NcKeyword::Do)
      expect_end(cursor);
    else
      count = std::round(condition(cursor));
    leave_loop(label);
    if (count >= 1)
      loops().push_back({label, keyword, after_line, count - 1});
    else
      skip(label, {NcKeyword::EndRepeat});
  } else {
    expect_end(cursor);
    if (!inside || inside->kind == NcKeyword::If) place_.fail("not within loop " + show(label));
    if (keyword == NcKeyword::EndWhile || keyword == NcKeyword::EndRepeat) return next_turn(label);
    const NcKeyword end = inside->kind == NcKeyword::While    ? NcKeyword::EndWhile
                          : inside->kind == NcKeyword::Repeat ? NcKeyword::EndRepeat
                                                              : NcKeyword::While;
    const auto [found, rest] = skip(label, {end});
    NcCursor after(rest, place_);
    if (keyword == NcKeyword::Break)
      leave_loop(label);
    else
      loop(label, found, after);
  }
}

}  // namespace riffler::nc
