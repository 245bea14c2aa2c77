// Tools, feed, M functions and control functions of Heidenhain programs.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include "nc/limits.hpp"
#include "nc/read/heidenhain_interpreter.hpp"

namespace riffler::nc {

namespace {

/// Heidenhain's M functions that are supported or have no effect on the tool path.
constexpr int kControlCodes[] = {0,   1,   2,   3,   4,   5,   6,   7,   8,   9,   13,  14,  19,  30,  89,  90,
                                 91,  92,  94,  95,  96,  97,  98,  99,  101, 102, 103, 104, 105, 106, 107, 108,
                                 109, 110, 111, 112, 113, 115, 116, 117, 118, 120, 124, 126, 127, 128, 129, 131,
                                 132, 134, 135, 136, 137, 138, 140, 141, 142, 143, 145, 148, 149, 197};

struct RefusedCode {
  int code;
  const char* why;
};
constexpr RefusedCode kRefusedCodes[] = {
    {114, "M114 corrects for tilted axes as the machine's tables say: have the post write M128"},
    {130, "M130 (positions in the untilted system) is not read: end the tilted plane before (PLANE RESET)"},
    {144, "M144 accounts for tilted axes as the machine's tables say: have the post write M128 or PLANE"},
};

}  // namespace

/// Number or name may be missing: then only speed and feed change.
void HeidenhainInterpreter::call_tool(HeidenhainCursor& cursor) {
  std::optional<int> tool;
  if (cursor.peek() == '"') {
    const std::string name = cursor.quoted();
    tool = text_->tool_number(name);
    if (noted_.insert(-*tool).second)
      note("tool", std::string("tool ") + std::to_string(*tool) + " is called by its name, " + name);
  } else if (cursor.at_number() || cursor.peek() == 'Q') {
    const double number = values_.value(cursor, "TOOL CALL");
    if (!(number >= 0 && number <= kMaxNumber)) place_.fail("the tool's number is out of range");
    if (number != std::floor(number))
      place_.fail("a tool with an index (TOOL CALL 5.1) is not read: give it a number of its own");
    tool = static_cast<int>(number);
  }
  for (const char axis : {'X', 'Y', 'U', 'V', 'W'})
    if (cursor.peek() == axis)
      place_.fail(std::string("the tool axis ") + axis + " is not read: Z is; have the post write TOOL CALL n Z");
  cursor.take_if('Z');
  if (tool) {
    refuse_in_compensation("TOOL CALL");
    tool_ = *tool, turning_ = 0, tool_more_ = 0;
    const HeidenhainBlock& block = (*text_)[next_ - 1];
    const double diameter = block.diameter > 0 ? block.diameter : text_->diameter(tool_);
    if (diameter > 0) tool_radii_.emplace(tool_, diameter / 2 * unit_);
  }
  while (cursor.peek() != '\0') {
    if (cursor.take_if('S')) {
      take_speed(values_.value(cursor, "S"));
    } else if (cursor.take_word("DL") || cursor.take_word("DR2")) {
      take_tool_delta(cursor, true);
    } else if (cursor.take_word("DR")) {
      const bool counts = rule_ == CompensationRule::Offset;
      const double more = take_tool_delta(cursor, !counts);
      if (counts) tool_more_ = more * unit_;
    } else if (cursor.peek() == 'F') {
      HeidenhainWords words;
      words.read_feed(cursor, values_);
      if (words.feed == HeidenhainFeed::Number || words.feed == HeidenhainFeed::PerTurn) {
        take_feed(words);
        call_feed_ = feed_, auto_per_turn_ = per_turn_;
      }
    } else {
      cursor.fail_unexpected();
    }
  }
}

/// DL, DR or DR2 of TOOL CALL: differences of the tool from its entry in the control's table.
double HeidenhainInterpreter::take_tool_delta(HeidenhainCursor& cursor, bool noted) {
  cursor.take_if(':');
  const double delta = values_.value(cursor, "DL, DR");
  if (delta != 0 && noted)
    note("tool length", "DL and DR of TOOL CALL are passed over: points are taken as those of the tip");
  return delta;
}

/// Length and radius of a tool, for controls without a tool table.
void HeidenhainInterpreter::define_tool(HeidenhainCursor& cursor) {
  if (!cursor.at_number()) return;
  const double number = cursor.number("TOOL DEF");
  while (cursor.peek() == 'L' || cursor.peek() == 'R' || cursor.peek() == 'F') {
    const bool radius = cursor.peek() == 'R';
    cursor.take();
    const double value = values_.value(cursor, "TOOL DEF") * unit_;
    if (radius && number <= kMaxNumber && value > 0) tool_radii_[static_cast<int>(number)] = value;
  }
}

void HeidenhainInterpreter::control_function(HeidenhainCursor& cursor) {
  if (cursor.take_word("RESET TCPM")) return keep_tip(false);
  if (!cursor.take_word("TCPM")) {
    for (const std::string_view nothing : {"MODE MILL", "DWELL", "FEED", "S-PULSE", "COUNT", "RESET"})
      if (cursor.take_word(nothing)) return;
    place_.fail("this FUNCTION is not read: it would move the tool or what follows; FUNCTION TCPM is");
  }
  bool spatial = false, along_vectors = false;
  while (cursor.peek() != '\0') {
    if (cursor.take_word("AXIS SPAT"))
      spatial = true;
    else if (cursor.take_word("PATHCTRL VECTOR"))
      along_vectors = true;
    else if (cursor.take_word("REFPNT TIP-CENTER") || cursor.take_word("REFPNT CENTER-CENTER"))
      place_.fail("FUNCTION TCPM with points of the tool's centre is not read: have the post write REFPNT TIP-TIP");
    else if (!(cursor.take_word("AXIS POS") || cursor.take_word("PATHCTRL AXIS") ||
               cursor.take_word("REFPNT TIP-TIP") || cursor.take_word("F TCP") || cursor.take_word("F CONT"))) {
      if (cursor.peek() != 'F') cursor.fail_unexpected();
      cursor.take();
      values_.value(cursor, "F");
    }
  }
  keep_tip(true);
  spatial_ = spatial, along_vectors_ = along_vectors, spatial_angles_ = Vec3(0);
}

/// M128, M129. Without M128, X Y Z are the tip only while the rotary axes are perpendicular to the working plane.
void HeidenhainInterpreter::keep_tip(bool on) {
  if (keeps_tip_ == on) return;
  keeps_tip_ = on, spatial_ = along_vectors_ = false;
  if (!on && !is_upright()) lose_place();
}

bool HeidenhainInterpreter::is_user_code(int code) const {
  return std::ranges::find(kControlCodes, code) == std::end(kControlCodes);
}

/// M functions that act at the start of their block.
void HeidenhainInterpreter::begin_codes(const HeidenhainWords& words) {
  for (const int code : words.codes) {
    for (const RefusedCode& refused : kRefusedCodes)
      if (refused.code == code) place_.fail(refused.why);
    if (is_user_code(code)) {
      if (noted_.insert(code).second)
        note("user code", std::string("M") + std::to_string(code) + " is the machine's own: taken to move nothing");
    } else if (code == 3 || code == 13) {
      turning_ = 1;
    } else if (code == 4 || code == 14) {
      turning_ = -1;
    } else if (code == 126) {
      shortest_ = true;
    } else if (code == 128) {
      keep_tip(true);
    } else if (code == 103 && noted_.insert(code).second) {
      note("feed", "M103 slows plunging down: its feeds are taken as those of F");
    } else if (code == 136 || code == 137) {
      if (per_turn_ != (code == 136)) feed_ = 0;
      per_turn_ = code == 136;
    } else if (code == 94) {
      for (std::size_t k = 3; k < rotary_.size(); ++k)
        if (words.reduced.empty() || std::ranges::find(words.reduced, kJointLetters[k]) != words.reduced.end())
          rotary_[k] -= 360 * std::floor(rotary_[k] / 360);
    }
  }
}

/// M functions that act at the end of their block.
void HeidenhainInterpreter::end_codes(const HeidenhainWords& words) {
  for (const int code : words.codes) {
    if (code == 5 || code == 19)
      turning_ = 0;
    else if (code == 127)
      shortest_ = false;
    else if (code == 129)
      keep_tip(false);
    else if (code == 2 || code == 30)
      ended_ = true, turning_ = 0;
  }
}

void HeidenhainInterpreter::take_feed(const HeidenhainWords& words) {
  if (words.speed) take_speed(*words.speed);
  if (words.feed == HeidenhainFeed::Auto) {
    feed_ = call_feed_, per_turn_ = auto_per_turn_;
  } else if (words.feed == HeidenhainFeed::PerTurn) {
    feed_ = words.feed_number * unit_, per_turn_ = true;
  } else if (words.feed == HeidenhainFeed::Number) {
    feed_ = words.feed_number * (per_turn_ ? unit_ : feed_unit_);
  } else {
    return;
  }
  if (!(feed_ >= 0 && feed_ <= kMaxFeed)) place_.fail("F is negative or out of range");
}

void HeidenhainInterpreter::take_speed(double speed) {
  if (!(speed >= 0 && speed <= kMaxSpindle)) place_.fail("S is negative or out of range");
  speed_ = speed;
}

NcRowWords HeidenhainInterpreter::row_words(bool rapid) {
  double feed = feed_;
  if (!rapid) {
    if (per_turn_ && !(speed_ > 0)) place_.fail("a feed per revolution without a spindle speed S");
    if (per_turn_) feed *= speed_;
    if (!(feed > 0)) place_.fail("a feed move without F");
    if (!(feed <= kMaxFeed)) place_.fail("F is out of range");
  }
  return {rapid, rapid ? 0 : feed, false, turning_ * speed_, tool_, place_.line};
}

}  // namespace riffler::nc
