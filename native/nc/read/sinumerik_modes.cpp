// G codes, feed, spindle and tool of Sinumerik programs.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include "nc/limits.hpp"
#include "nc/read/sinumerik_interpreter.hpp"
#include "nc/read/tool_diameters.hpp"

namespace riffler::nc {

namespace {

/// Exact stop, continuous path, corners of compensation, approach feeds: no effect on the path of the tool's centre.
constexpr int kQuietCodes[] = {9,   40,  60,  62,  64,  290, 450, 451, 460, 461, 462,
                               601, 602, 603, 621, 641, 642, 643, 644, 645, 340, 341};

/// M functions that every control has.
constexpr int kControlFunctions[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 17, 19, 30, 40, 41, 42, 43, 44, 45, 70};

struct RefusedCodes {
  int first, last;
  const char* why;
};
constexpr RefusedCodes kRefusedG[] = {
    {33, 35, "threads are cut by the spindle's position: they are not read"},
    {331, 332, "tapping by the spindle's position is not read: have the CAM system write CYCLE84"},
    {58, 59, "offsets of single axes are not read: have the CAM system write TRANS and ATRANS"},
    {110, 112, "polar coordinates are not read: have the CAM system write X and Y"},
    {140, 143, "approaches to a compensated contour are not read: have the CAM system write their moves"},
    {147, 148, "approaches to a compensated contour are not read: have the CAM system write their moves"},
    {247, 248, "approaches to a compensated contour are not read: have the CAM system write their moves"},
    {347, 348, "approaches to a compensated contour are not read: have the CAM system write their moves"},
    {291, 291, "it switches to ISO code: read that part with a machine whose control is rs274"},
    {810, 829, "a code of the machine's own is not read: take it out, or write what it does"},
};

}  // namespace

void SinumerikInterpreter::take_codes(SinumerikWords& words) {
  for (const int code : words.codes) {
    if (take_code(code)) continue;
    for (const RefusedCodes& refused : kRefusedG)
      if (code >= refused.first && code <= refused.last)
        place_.fail(std::string("G") + std::to_string(code) + ": " + refused.why);
    place_.fail(std::string("unknown code G") + std::to_string(code) + ": correct it, or take it out");
  }
  homes_ = homes_ || words.has_code(74) || words.has_code(75);
}

bool SinumerikInterpreter::take_code(int code) {
  if (std::ranges::find(kQuietCodes, code) != std::end(kQuietCodes)) return true;
  if (code >= 505 && code <= 599) {
    select_system(code - 500);
    return true;
  }
  switch (code) {
    case 0:
    case 1:
    case 2:
    case 3:
      motion_ = static_cast<Motion>(code + 1);
      return true;
    case 4:
      return dwells_ = true;
    case 17:
      plane_ = {0, 1, 2};
      return true;
    case 18:
      plane_ = {2, 0, 1};
      return true;
    case 19:
      plane_ = {1, 2, 0};
      return true;
    case 25:
    case 26:
      return bounds_ = true;
    case 41:
    case 42:
      compensate(code);
      return true;
    case 53:
    case 153:
      return by_machine_ = true;
    case 54:
    case 55:
    case 56:
    case 57:
      select_system(code - 53);
      return true;
    case 500:
      select_system(0);
      return true;
    case 63:
      return taps_ = true;
    case 70:
    case 71:
    case 700:
    case 710:
      take_units(code);
      return true;
    case 74:
    case 75:
      return homes_ = true;
    case 90:
    case 91:
      absolute_ = code == 90;
      return true;
    case 93:
    case 94:
    case 95:
      if (feed_mode_ != code) feed_ = 0;  // a feed number of one mode has no meaning in another
      feed_mode_ = code, surface_speed_ = false;
      return true;
    case 96:
    case 961:
    case 962:
      surface_speed_ = true, speed_ = 0;
      return true;
    case 97:
    case 971:
    case 972:
    case 973:
      surface_speed_ = false;
      return true;
    default:
      return false;
  }
}

/// G70 and G71 apply to lengths only, G700 and G710 also to feeds.
void SinumerikInterpreter::take_units(int code) {
  const bool inch = code == 70 || code == 700;
  unit_ = inch ? kInch : 1;
  feed_unit_ = code >= 700 ? unit_ : basic_unit_;
  units_said_ = true;
  if (code < 700 && unit_ != basic_unit_ && !units_given_)
    note_once(-11, "units",
              std::string("G") + std::to_string(code) +
                  " is of lengths, not of F, which is in the control's own unit: assumed to be mm; set option units");
}

void SinumerikInterpreter::take_feed(const SinumerikWords& words) {
  if (feed_mode_ == 93) feed_ = 0;  // F applies to its own block only
  block_feed_ = 0;
  const auto of = [&](double number) {
    const double feed = number * (feed_mode_ == 93 ? 1 : feed_mode_ == 95 ? unit_ : feed_unit_);
    if (!(feed >= 0 && feed <= kMaxFeed)) place_.fail("F is negative or out of range");
    return feed;
  };
  if (dwells_) {
    if (!words.feed && !words.speed) place_.fail("G4 needs F (seconds) or S (turns)");
    if (words.has_linear() || words.has_rotary()) place_.fail("axis words together with G4");
    return;
  }
  if (words.feed) feed_ = of(*words.feed);
  if (words.block_feed) block_feed_ = of(*words.block_feed);
  if (words.speed && !surface_speed_ && !bounds_) {
    if (!(*words.speed >= 0 && *words.speed <= kMaxSpindle)) place_.fail("S is negative or out of range");
    speed_ = *words.speed;
  }
}

// --- Spindle, tool ---

void SinumerikInterpreter::begin_functions(const SinumerikWords& words) {
  for (const SinumerikCode& code : words.functions) {
    if (std::ranges::find(kControlFunctions, code.number) == std::end(kControlFunctions)) {
      note_once(
          code.number, "user code",
          std::string("M") + std::to_string(code.number) + " is a function of the machine: taken to move nothing");
    } else if (is_of_master(code) && (code.number == 3 || code.number == 4)) {
      turning_ = code.number == 3 ? 1 : -1;
    } else if (is_of_master(code) && (code.number == 5 || code.number == 19 || code.number == 70)) {
      turning_ = 0;
    } else if (code.number == 6) {
      tool_ = next_tool_, turning_ = 0;
    }
  }
}

void SinumerikInterpreter::end_functions(const SinumerikWords& words) {
  for (const SinumerikCode& code : words.functions) {
    if (code.number != 2 && code.number != 17 && code.number != 30) continue;
    if (calls_.size() > 1) return leave();
    ended_ = true;
  }
}

void SinumerikInterpreter::take_tool(const SinumerikWords& words) {
  if (words.tool) next_tool_ = *words.tool;
  if (!words.tool_name.empty()) next_tool_ = number_of_tool(words.tool_name);
  if (words.edge) length_off_ = *words.edge == 0;
}

/// Tools called by name get the numbers after those of tools called by number.
int SinumerikInterpreter::number_of_tool(const std::string& name) {
  const bool number = name.size() < 9 && std::ranges::all_of(name, NcCursor::is_digit);
  if (number) return std::stoi(name);
  const auto known = std::ranges::find(tool_names_, name);
  const int out =
      static_cast<int>(std::min<std::ptrdiff_t>(last_tool_ + 1 + (known - tool_names_.begin()), kMaxNumber));
  if (known == tool_names_.end()) {
    tool_names_.push_back(name);
    note("tool", std::string("tool ") + std::to_string(out) + " is called by its name, " + name);
  }
  return out;
}

void SinumerikInterpreter::compensate(int code) {
  const std::string name = std::string("G") + std::to_string(code);
  if (!ignore_compensation_)
    place_.fail("cutter radius compensation (" + name +
                ") is not read: have the CAM system write the path of the tool's centre, or, where that is what the "
                "program has, read it with options {'cutter_compensation': 'ignore'}");
  note_once(-12, "cutter compensation", compensation_ignored(name));
}

NcRowWords SinumerikInterpreter::row_words(bool rapid) {
  if (length_off_ && !by_machine_ && !homes_) {
    note("tool length", "a move under D0: its points are taken as those of the tip");
    length_off_ = false;
  }
  double feed = block_feed_ > 0 ? block_feed_ : feed_;
  if (!rapid) {
    if (feed_mode_ == 95 && (surface_speed_ || !(speed_ > 0)))
      place_.fail("a feed per revolution (G95) without a spindle speed S");
    if (feed_mode_ == 95) feed *= speed_;
    if (!(feed > 0))
      place_.fail(feed_mode_ == 93 ? "a feed move without F: under G93 every block needs its own"
                                   : "a feed move without F");
    if (!(feed <= kMaxFeed)) place_.fail("F is out of range");
  }
  return {rapid, rapid ? 0 : feed, feed_mode_ == 93, turning_ * speed_, tool_, calls_.front().line};
}

/// A work offset, whose position on the machine is not in the program.
void SinumerikInterpreter::select_system(int system) {
  system_ = system;
}

}  // namespace riffler::nc
