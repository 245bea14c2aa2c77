#include "nc/read/heidenhain_interpreter.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "nc/limits.hpp"
#include "nc/machine/header.hpp"
#include "nc/machine/machines.hpp"
#include "nc/machine/post_options.hpp"
#include "nc/read/heidenhain_reader.hpp"

namespace riffler::nc {

namespace {

/// Unsupported statements that would move the tool or affect later moves.
constexpr std::string_view kMovingStatements[] = {"APPR",    "DEP",  "FPOL",   "FL",       "FLT",    "FC",    "FCT",
                                                  "FSELECT", "SPL",  "TCH",    "SEL",      "PGM",    "TRANS", "PATTERN",
                                                  "CONTOUR", "GOTO", "MIRROR", "POLARKIN", "TABDATA"};

}  // namespace

Program parse_heidenhain(std::string_view text, const std::string& file, const ReadOptions& options) {
  return HeidenhainInterpreter(text, file, options).run();
}

HeidenhainInterpreter::HeidenhainInterpreter(std::string_view text, const std::string& file, const ReadOptions& options)
    : place_{file, 0, {}}, values_(place_), source_(file), progress_(options.progress) {
  take_options(options);
  NcSource source(text, file);
  if (check_header_) nc::check_header(source, rows_->machine());
  text_ = std::make_unique<HeidenhainText>(text, place_);
}

void HeidenhainInterpreter::take_options(const ReadOptions& options) {
  OptionReader taken(options.options, "machine " + options.machine);
  std::unique_ptr<Machine> machine = make_machine(options.machine, taken);
  const double chord = taken.positive("chord_tolerance").value_or(0.002);
  const std::optional<double> axis = taken.positive("axis_tolerance");
  take_post_options(taken);                                     // reading and writing share these options
  arc_miss_ = taken.positive("arc_tolerance").value_or(0.016);  // as the control itself
  block_delete_ = taken.flag("block_delete", false);
  check_header_ = taken.word("header", {"check", "ignore"}, "check") == "check";
  max_turns_ = taken.positive("max_turns").value_or(1e6);
  skip_unknown_ = taken.word("unknown", {"error", "skip"}, "error") == "skip";
  rule_ = take_compensation_rule(taken);
  diameters_.take(options.options, taken);
  taken.done();
  if (machine->joint_words())
    throw std::invalid_argument("machine " + machine->name() +
                                ": code for a Heidenhain control has tip coordinates (M128): tcp must not be False");
  if (chord < 1e-6) throw std::invalid_argument("option chord_tolerance must be at least 1e-6 mm");
  if (axis && *axis < 1e-6) throw std::invalid_argument("option axis_tolerance must be at least 1e-6 rad");
  rows_ = std::make_unique<NcRows>(std::move(machine), chord, axis, place_);
  make_compensation();
}

Program HeidenhainInterpreter::run() {
  constexpr std::uint64_t kBlocksAReport = 1024;
  begin_program();
  for (std::uint64_t n = 0; !ended_ && next_ < text_->size(); ++n) {
    if (n % kBlocksAReport == 0)
      base::report(progress_, static_cast<double>(next_) / static_cast<double>(text_->size()));
    const HeidenhainBlock& block = (*text_)[next_++];
    if (block.optional && block_delete_) continue;
    execute(block);
    flush();
  }
  if (corner_) place_.fail("RND or CHF without the line after it");
  compensation_->off();
  flush();
  program_.provenance = notes_.provenance(source_), program_.notes = notes_.notes();
  return std::move(program_);
}

void HeidenhainInterpreter::begin_program() {
  const bool begins = text_->size() > 0;
  if (begins) place_.line = (*text_)[0].line, place_.text = (*text_)[0].text;
  HeidenhainCursor cursor(begins ? (*text_)[0].text : "", place_);
  if (!cursor.take_word("BEGIN PGM")) place_.fail("a conversational program begins with BEGIN PGM");
  next_ = 1;
  std::string_view name = cursor.rest().substr(0, cursor.rest().find(';'));
  while (!name.empty() && name.back() == ' ') name.remove_suffix(1);
  const auto ends_with = [&](std::string_view unit) {
    if (name.size() < unit.size()) return false;
    const std::string_view last = name.substr(name.size() - unit.size());
    return std::ranges::equal(last, unit, [](char a, char b) { return NcCursor::upper(a) == b; });
  };
  // For resolution, F counts tenths of inches.
  if (ends_with("INCH"))
    unit_ = kInch, feed_unit_ = kInch / 10;
  else if (!ends_with("MM"))
    note("units", "BEGIN PGM says neither MM nor INCH: taken as millimetres");
  set_plane_parameters({});
}

void HeidenhainInterpreter::execute(const HeidenhainBlock& block) {
  place_.line = block.line, place_.text = block.text.substr(0, block.text.find_first_of("\r\n"));
  HeidenhainCursor start(block.text, place_), cursor(block.text, place_);
  const std::string word = cursor.letters();
  if (word == "Q" || word == "QL" || word == "QR") return assign(start);
  if (word == "M") {
    HeidenhainWords words;
    words.read(start, values_, 0);
    return line(words);
  }
  if (!execute_motion(word, cursor) && !execute_definition(word, cursor)) unknown(word);
}

bool HeidenhainInterpreter::execute_motion(const std::string& word, HeidenhainCursor& cursor) {
  using W = HeidenhainWords;
  struct Statement {
    std::string_view name;
    int kinds;
    void (HeidenhainInterpreter::*of)(W&);
  };
  static constexpr Statement kMotions[] = {
      {"L", 0, &HeidenhainInterpreter::line},
      {"LN", W::Normal | W::ToolAxis, &HeidenhainInterpreter::vector_line},
      {"LP", W::Polar, &HeidenhainInterpreter::polar_line},
      {"CC", 0, &HeidenhainInterpreter::circle_centre},
      {"C", W::Turning, &HeidenhainInterpreter::circle},
      {"CR", W::Turning | W::Radius, &HeidenhainInterpreter::radius_circle},
      {"CP", W::Turning | W::Polar, &HeidenhainInterpreter::polar_circle},
  };
  const auto found = std::ranges::find(kMotions, word, &Statement::name);
  W words;
  if (found != std::end(kMotions)) {
    words.read(cursor, values_, static_cast<std::uint8_t>(found->kinds));
    (this->*found->of)(words);
  } else if (word == "CT" || word == "CTP") {
    words.read(cursor, values_, word == "CT" ? 0 : W::Polar);
    tangent_circle(words, word == "CTP");
  } else if (word == "RND" || word == "CHF") {
    words.read(cursor, values_, word == "RND" ? W::Radius | W::Length : W::Length);
    corner(words, word == "RND");
  } else if (word == "STOP") {
    words.read(cursor, values_, 0);
    if (words.has_linear() || words.has_rotary()) place_.fail("axis words together with STOP");
    line(words);
  } else {
    return false;
  }
  return true;
}

bool HeidenhainInterpreter::execute_definition(const std::string& word, HeidenhainCursor& cursor) {
  if (word == "END" && cursor.take_word("PGM")) {
    ended_ = true;
  } else if (word == "TOOL" && cursor.take_word("CALL")) {
    call_tool(cursor);
  } else if (word == "TOOL" && cursor.take_word("DEF")) {
    define_tool(cursor);
  } else if ((word == "CYCL" || word == "CYCLE") && cursor.take_word("DEF")) {
    define_cycle(cursor);
  } else if ((word == "CYCL" || word == "CYCLE") && cursor.take_word("CALL")) {
    if (cursor.take_word("POS") || cursor.take_word("PAT"))
      place_.fail("CYCL CALL POS and PAT are not read: have the post write a positioning block with M99 for each hole");
    HeidenhainWords words;
    words.read(cursor, values_, 0);
    if (words.has_linear() || words.has_rotary()) place_.fail("axis words together with CYCL CALL");
    begin_codes(words);
    take_feed(words);
    call_cycle();
    calls_everywhere_ = false;
    end_codes(words);
  } else if (word == "CALL") {
    call(cursor);
  } else if (word == "LBL") {
    label(cursor);
  } else if (word == "FN") {
    function(cursor);
  } else if (word == "FUNCTION") {
    control_function(cursor);
  } else if (word == "PLANE") {
    plane(cursor);
  } else if (word == "TRANS" && cursor.take_word("DATUM")) {
    if (cursor.take_word("RESET"))
      reset_datum();
    else if (cursor.take_word("AXIS"))
      shift_datum(cursor);
    else
      place_.fail("TRANS DATUM is read with AXIS and RESET: only the control knows the datum table");
  } else if (word == "BEGIN") {
    place_.fail("BEGIN PGM within a program: give each program a file of its own");
  } else {
    return word == "BLK" || word == "QS";  // shape of the stock; texts
  }
  return true;
}

void HeidenhainInterpreter::unknown(const std::string& word) {
  const bool moves = std::ranges::find(kMovingStatements, word) != std::end(kMovingStatements);
  if (word == "TCH")
    place_.fail("probing (TCH PROBE) cannot be simulated: only the machine knows what it measures; take it out");
  if (moves)
    place_.fail(word +
                " is not read: it would move the tool or what follows; have the CAM system write L and C blocks");
  if (word.empty() || !skip_unknown_)
    place_.fail(std::string("unknown statement ").append(word) +
                ": correct it, or read with options {'unknown': 'skip'}");
  note("skipped", word);
}

void HeidenhainInterpreter::expect_end(HeidenhainCursor& cursor) {
  if (cursor.peek() != '\0') cursor.fail_unexpected();
}

void HeidenhainInterpreter::flush() {
  std::vector<Move>& pending = rows_->pending();
  if (program_.size() + pending.size() > kMaxRows) place_.fail("more rows than can be stored");
  for (const Move& move : pending) program_.append(move);
  pending.clear();
}

void HeidenhainInterpreter::note(const char* kind, const std::string& message) {
  notes_.add(kind, place_.line, message);
}

}  // namespace riffler::nc
