// Cycles of Heidenhain programs: CYCL DEF and the calls.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <string>

#include "geom/math.hpp"
#include "nc/limits.hpp"
#include "nc/number_text.hpp"
#include "nc/read/heidenhain_interpreter.hpp"

namespace riffler::nc {

namespace {

/// Cycles that act where they are defined without motion: dwell, spindle, tolerance, and data for other cycles.
constexpr int kQuietCycles[] = {9, 13, 14, 20, 32, 238, 239, 270, 271};
/// Machine builders' cycles for acceleration.
constexpr int kTuningCycles[] = {332, 392};
/// Cycles that act where they are defined, at once or on what follows.
constexpr int kActingCycles[] = {8, 11, 12, 26, 220, 221};

/// Parameters of hole cycles.
constexpr int kHoleParameters[] = {200, 201, 202, 203, 204, 205, 206, 208, 212, 213, 214, 239, 253,
                                   256, 257, 258, 259, 334, 335, 339, 351, 357, 379, 426, 427, 428};

bool is_one_of(int number, std::span<const int> numbers) {
  return std::ranges::find(numbers, number) != numbers.end();
}

}  // namespace

void HeidenhainInterpreter::define_cycle(HeidenhainCursor& cursor) {
  const double given = cursor.number("CYCL DEF");
  if (!(given <= 9999)) place_.fail("there is no such cycle");
  const int number = static_cast<int>(given);
  int part = static_cast<int>(std::lround((given - number) * 10));
  if (cursor.peek() == '.' && cursor.at_number()) part = static_cast<int>(std::lround(cursor.number("CYCL DEF") * 10));
  if (number < 200) return define_old(number, part, cursor);
  // Values left by another cycle must not stand in for parameters that this one does not name.
  for (const int parameter : kHoleParameters) values_.forget(parameter);
  take_parameters(cursor);
  if (number == 247) return use_preset();
  if (is_one_of(number, kTuningCycles)) {
    if (noted_.insert(10'000 + number).second)
      note("user code",
           std::string("cycle ") + std::to_string(number) + " is the machine's own tuning: taken to move nothing");
    return;
  }
  if (is_one_of(number, kQuietCycles)) return;
  if (is_one_of(number, kActingCycles) || number >= 400)
    place_.fail(std::string("cycle ") + std::to_string(number) + " is not read: have the CAM system write its moves");
  if (number >= 300) {
    if (!skip_unknown_)
      place_.fail(std::string("cycle ") + std::to_string(number) +
                  " is the machine builder's own: take it out, or read with options {'unknown': 'skip'} where it moves "
                  "nothing");
    return note("skipped", std::string("CYCL DEF ") + std::to_string(number));
  }
  cycle_ = number, calls_everywhere_ = false;
}

/// Cycles below 200 have several parts, each a block.
void HeidenhainInterpreter::define_old(int number, int part, HeidenhainCursor& cursor) {
  const std::string name = std::string("cycle ") + std::to_string(number);
  switch (number) {
    case 7:
      return part == 0 ? void() : shift_datum(cursor);
    case 10:
      return part == 0 ? void() : rotate(cursor);
    case 19:
      return part == 1 ? old_plane(cursor) : void();
    case 1:
    case 2:
      cycle_ = number, calls_everywhere_ = false;
      if (part == 0) return old_cycle_.fill(std::nullopt);
      if (part > 5) place_.fail(name + " has no such part");
      // Skip a name before the number, which depends on the language and may touch the number.
      while (cursor.peek() != '\0' && !cursor.at_number() && cursor.peek() != '+' && cursor.peek() != '-' &&
             cursor.peek() != 'Q')
        cursor.take();
      old_cycle_[static_cast<std::size_t>(part) - 1] = values_.value(cursor, "CYCL DEF");
      return;
    case 8:
    case 11:
    case 26:
      if (part == 0 || cursor.peek() == '\0') return;  // without values: cancelled
      if (number == 11 && cursor.take_word("SCL") && values_.value(cursor, "SCL") == 1) return;
      place_.fail(name + (number == 8 ? " (mirroring)" : " (scaling)") +
                  " is not read: have the CAM system write the final moves");
    case 12:
      place_.fail("cycle 12 calls another program, which is not read: paste it in as a label (LBL), and call that");
    default:
      if (!is_one_of(number, kQuietCycles)) cycle_ = number, calls_everywhere_ = false;
  }
}

/// Q parameters after the cycle's name; AUTO is the feed of TOOL CALL.
void HeidenhainInterpreter::take_parameters(HeidenhainCursor& cursor) {
  while (cursor.peek() != '\0') {
    if (cursor.peek() != 'Q') {
      cursor.letters().empty() ? cursor.take() : void();
      continue;
    }
    HeidenhainCursor ahead(cursor.rest(), place_);
    ahead.take();
    if (!ahead.at_number()) {  // part of a name
      cursor.letters();
      continue;
    }
    const int key = values_.name(cursor);
    if (!cursor.take_if('=')) cursor.fail(HeidenhainValues::shown(key) + " without =");
    if (cursor.take_word("AUTO") || cursor.take_word("FAUTO"))
      values_.set(key, call_feed_ / feed_unit_);
    else if (cursor.take_word("MAX") || cursor.take_word("FMAX"))
      values_.set(key, kHeidenhainFmax);
    else if (cursor.peek() == '"' || cursor.take_word("QS"))
      cursor.peek() == '"' ? void(cursor.quoted()) : void(cursor.number("QS"));
    else
      values_.set(key, values_.operand(cursor, HeidenhainValues::shown(key)));
  }
}

void HeidenhainInterpreter::shift_datum(HeidenhainCursor& cursor) {
  if (cursor.take_if('#'))
    place_.fail("cycle 7 with a line of the datum table is not read: only the control knows what the table has");
  HeidenhainWords words;
  words.read(cursor, values_, 0);
  for (std::size_t k = 3; k < words.axes.size(); ++k)
    if (words.axes[k].value != 0) place_.fail("cycle 7 with a rotary axis is not read: have the post write its angles");
  HeidenhainFrame frame = frame_;
  for (std::size_t k = 0; k < 3; ++k) {
    const HeidenhainCoordinate& axis = words.axes[k];
    const int i = static_cast<int>(k);
    if (!axis.given) continue;
    if (!axis.incremental && axis.value == 0) {
      frame.shift[i] = frame.plane_shift[i] = 0;
    } else if (!frame.tilted) {
      frame.shift[i] = axis.from(frame.shift[i], unit_);
    } else {
      if (frame.shift != Vec3(0) && axis.value != 0)
        place_.fail("a datum shift in a tilted plane on top of one from before it is not read: PLANE RESET before it");
      frame.plane_shift[i] = axis.from(frame.plane_shift[i], unit_);
    }
  }
  check_length(frame.shift), check_length(frame.plane_shift);
  use_frame(frame);
}

void HeidenhainInterpreter::reset_datum() {
  HeidenhainFrame frame = frame_;
  frame.shift = frame.plane_shift = Vec3(0);
  use_frame(frame);
}

void HeidenhainInterpreter::rotate(HeidenhainCursor& cursor) {
  const bool incremental = cursor.take_word("IROT");
  if (!incremental && !cursor.take_word("ROT")) cursor.fail_unexpected();
  HeidenhainFrame frame = frame_;
  if (cursor.peek() == '\0')
    frame.rotation = 0;
  else
    frame.rotation = values_.value(cursor, "ROT") + (incremental ? frame.rotation : 0);
  if (!(std::abs(frame.rotation) <= kMaxAngle)) place_.fail("ROT is out of range");
  use_frame(frame);
}

/// Cycle 247: a line of the preset table. It ends datum shift and rotation.
void HeidenhainInterpreter::use_preset() {
  const double preset = values_.needed(339, "the number of the preset");
  const std::string shown = std::to_string(static_cast<long long>(std::clamp(preset, -1.0, 1e9)));
  if (!preset_)
    note("work offset", "preset " + shown + ": the part is where its coordinates are");
  else if (*preset_ != preset)
    note("work offset",
         "preset " + shown + ": its distance from the one before is not in the program, assumed to be 0");
  preset_ = preset;
  reset_datum();
  HeidenhainFrame frame = frame_;
  frame.rotation = 0;
  use_frame(frame);
}

void HeidenhainInterpreter::call_cycle() {
  refuse_in_compensation("a cycle");
  stay_beside_contour();
  if (cycle_ == 0) place_.fail("a call without a cycle: CYCL DEF before it");
  if (!is_heidenhain_hole(cycle_) && cycle_ != 208)
    place_.fail(std::string("cycle ") + std::to_string(cycle_) +
                " is not read (1, 2, 200 to 203, 205 to 209 and 241 are): have the CAM system write its moves");
  if (stand_[0] == Stand::Machine || stand_[1] == Stand::Machine || (cycle_ < 200 && stand_[2] == Stand::Machine))
    place_.fail("a cycle while " + axes_away() + " is at a machine position: move into the part first");
  if (!is_upright()) fail_tilted();
  if (cycle_ == 208) return bore();
  const HeidenhainCycleSetting setting{unit_, feed_unit_, speed_, at_.z, old_cycle_};
  const Vec3 hole = at_;
  heidenhain_hole(cycle_, setting, values_, place_, [&](const HoleStroke& stroke) {
    NcRowWords words{stroke.feed == 0, stroke.feed, false, stroke.spindle.value_or(turning_ * speed_), tool_,
                     place_.line};
    stand_[2] = Stand::Given;
    move_to({hole.x + stroke.aside.x, hole.y + stroke.aside.y, stroke.height}, rotary_, words);
    if (rows_->pending().size() > kMaxRows) place_.fail("more rows than can be stored");
  });
  leaving_.reset();
}

/// Cycle 208: bores by a helix, whose radius follows from the tool's.
void HeidenhainInterpreter::bore() {
  const auto found = tool_radii_.find(tool_);
  if (found == tool_radii_.end())
    place_.fail(
        "cycle 208 (bore milling) needs the tool's radius, which is in the control's table: put a comment with its "
        "diameter, D=10, before TOOL CALL, or have the CAM system write the helix");
  const auto length = [&](int q, const char* what) {
    const double value = values_.needed(q, what) * unit_;
    if (!(std::abs(value) <= kMaxLength)) place_.fail(std::string("Q") + std::to_string(q) + " is out of range");
    return value;
  };
  const double depth = length(201, "the depth"), surface = length(203, "the coordinate of the surface");
  const double clear = surface + length(200, "the set-up clearance"), bottom = surface + depth;
  const double level = std::max(clear, surface + length(204, "the second set-up clearance"));
  const double radius = length(335, "the diameter of the bore") / 2 - found->second, pitch = length(334, "the infeed");
  const double feed = values_.needed(206, "the feed") * feed_unit_;
  if (depth == 0) return;
  if (depth > 0 || clear < bottom) place_.fail("Q201, the depth of cycle 208, must be negative");
  if (!(feed > 0 && feed <= kMaxFeed)) place_.fail("Q206, the feed, is 0 or out of range");
  if (!(pitch > 0)) place_.fail("Q334, the infeed, must be positive");
  if (radius < -1e-9) place_.fail("the tool is larger than the bore of cycle 208");
  if (noted_.insert(10'208).second)
    note("bore milling",
         "cycle 208: a helix from the side of +X with the radius of the tool in comments or TOOL DEF, " +
             number_text(found->second) + " mm; where the control begins it is not in the program");
  const double spindle = turning_ * speed_;
  const NcRowWords rapid{true, 0, false, spindle, tool_, place_.line};
  const NcRowWords cut{false, feed, false, spindle, tool_, place_.line};
  const Vec3 centre = at_;
  const bool climb = !values_.has(351) || values_.needed(351, "the kind of milling") >= 0;
  stand_[2] = Stand::Given;
  move_to({centre.x, centre.y, clear}, rotary_, rapid);
  if (radius > kMinRadius) {
    move_to({centre.x + radius, centre.y, clear}, rotary_, cut);
    // Whole turns of at most the infeed, and one at the bottom.
    const double turns = std::ceil((clear - bottom) / pitch - 1e-9), sense = climb ? 1 : -1;
    if (!(turns <= 1e5)) place_.fail("Q334, the infeed, is too small");
    const Arc round{{centre.x, centre.y}, radius, radius, 0, sense * kTwoPi * turns};
    arc_rows({centre.x + radius, centre.y, bottom}, round, 0, 1, rotary_, cut);
    arc_rows(at_, {{centre.x, centre.y}, radius, radius, 0, sense * kTwoPi}, 0, 1, rotary_, cut);
    move_to({centre.x, centre.y, bottom}, rotary_, cut);
  } else {
    move_to({centre.x, centre.y, bottom}, rotary_, cut);
  }
  move_to({centre.x, centre.y, level}, rotary_, rapid);
  leaving_.reset();
}

}  // namespace riffler::nc
