#include "nc/read/words.hpp"

#include <cmath>
#include <cstdio>

#include "nc/limits.hpp"
#include "nc/machine/machines.hpp"
#include "nc/read/expression.hpp"

namespace riffler::nc {

namespace {

constexpr std::int8_t kUnknown = -1;

/// Modal group of each code, indexed by the code times ten.
using CodeTable = std::array<std::int8_t, 4400>;

constexpr void put(CodeTable& table, NcGroup group, std::initializer_list<int> tenths) {
  for (const int code : tenths) table[static_cast<std::size_t>(code)] = static_cast<std::int8_t>(group);
}

constexpr CodeTable g_codes() {
  CodeTable t{};
  t.fill(kUnknown);
  using enum NcGroup;
  put(t, Motion, {0, 10, 20, 30, 50, 51, 52, 53, 330, 331, 382, 383, 384, 385, 730, 740, 760, 800});
  put(t, Motion, {810, 820, 830, 840, 850, 860, 870, 880, 890});
  put(t, NonModal, {40, 100, 280, 281, 300, 301, 520, 530, 920, 921, 922, 923});
  put(t, Plane, {170, 171, 180, 181, 190, 191});
  put(t, Units, {200, 210});
  put(t, CutterCompensation, {400, 410, 411, 420, 421});
  put(t, ToolLength, {430, 431, 432, 434, 490});
  put(t, WorkOffset, {540, 550, 560, 570, 580, 590, 591, 592, 593});
  put(t, PathControl, {610, 611, 640});
  put(t, LatheRadius, {70, 80});
  put(t, Distance, {900, 910});
  put(t, ArcDistance, {901, 911});
  put(t, FeedMode, {930, 940, 950});
  put(t, SpindleMode, {960, 970});
  put(t, ReturnLevel, {980, 990});
  // Fanuc's unit codes, LinuxCNC's G20 and G21.
  put(t, Units, {700, 710});
  // Cancels polar coordinates, scaling, mirroring and rotated planes, none of which is supported.
  put(t, Off, {150, 500, 501, 690});
  return t;
}

constexpr CodeTable m_codes() {
  CodeTable t{};
  t.fill(kUnknown);
  using enum NcGroup;
  put(t, Stop, {0, 10, 20, 300, 600});
  put(t, Spindle, {30, 40, 50, 130, 140, 190});
  put(t, ToolChange, {60, 610});
  put(t, Mist, {70});
  put(t, Flood, {80, 90});
  put(t, Override, {480, 490, 500, 510, 520, 530});
  put(t, Signal, {290, 620, 630, 640, 650, 660, 670, 680});
  put(t, State, {700, 710, 720, 730});
  put(t, Subprogram, {980, 990});
  put(t, Kinematics, {4280, 4290, 4300});
  for (int code = 1000; code <= 1990; code += 10) put(t, User, {code});
  // Machine functions by Haas, Fanuc, Mazak and others: brakes of rotary axes, chip conveyors, nozzles, gears, air and
  // coolant through the tool.
  put(t, User, {100, 110, 310, 330, 340, 350, 400, 410, 420, 430, 440, 450, 830, 840, 880, 890});
  return t;
}

constexpr CodeTable kG = g_codes(), kM = m_codes();

constexpr const char* kAdvice = ": correct it, or read with options {'unknown': 'skip'}";

/// Codes that change the meaning of later positions: if skipped, everything after them would be displaced.
const char* never_skipped(char letter, double value) {
  if (letter != 'G') return nullptr;
  const int tenths = static_cast<int>(std::round(value * 10));
  switch (tenths) {
    case 121:
    case 131:
    case 160:
      return "polar coordinates";
    case 510:
    case 511:
      return "scaling and mirrors";
    case 680:
    case 681:
      return "a turned coordinate system";
    case 682:
    case 683:
    case 684:
    case 531:
    case 533:
    case 536:
      return "a tilted plane";
    case 541:
    case 1540:
      return "a work offset beyond G59.3";
    default:
      return nullptr;
  }
}

}  // namespace

std::string nc_code_name(char letter, int tenths) {
  const std::string text = letter + std::to_string(tenths / 10);
  return tenths % 10 ? text + '.' + std::to_string(tenths % 10) : text;
}

void NcWords::read(NcCursor& cursor, NcParameters& parameters) {
  constexpr std::uint32_t kKnown = [] {
    std::uint32_t bits = 0;
    for (const char letter : std::string_view("DEFHIJKLNPQRSTXYZ")) bits |= bit(letter);
    return bits;
  }();
  if (!axis_bits_)
    for (const char letter : axes_) axis_bits_ |= bit(letter);
  given_ = used_ = groups_ = 0;
  empty_ = true, skipped_ = skipped_g_ = lost_axes_ = false;
  codes_.fill(-1);
  while (const char c = cursor.peek()) {
    if (c == '#') {
      empty_ = false;
      cursor.take();
      nc_assignment(cursor, parameters, place_);
      continue;
    }
    if (c == '@' || c == '^') place_.fail("polar coordinates (@, ^) are not read: write X and Y");
    if (!NcCursor::is_letter(c)) cursor.fail_character();
    if (c == 'O') place_.fail("an O-word must be first in its block");
    cursor.take();
    const double value = cursor.at_number() ? cursor.number(c) : nc_value(cursor, parameters, place_, c);
    if (c == 'G' || c == 'M') {
      add_code(c, value);
    } else if (!((kKnown | axis_bits_) & bit(c))) {
      skip_letter(c);
    } else {
      if (c == 'N') place_.fail("N must be first in its block");
      if (has(c)) place_.fail(std::string(1, c) + " twice in one block");
      given_ |= bit(c);
      values_[static_cast<std::size_t>(c - 'A')] = value;
    }
    empty_ = false;
  }
  take_look_ahead();
  if (skipped_) take_skipped_words();
}

/// Fanuc's G05 P10000, G05.1 Q1 and G08 P1 switch the look-ahead; LinuxCNC's G5 and G5.1 are splines, recognised by
/// their words.
void NcWords::take_look_ahead() {
  if (const int units = code(NcGroup::Units); units >= 700 && (has('Q') || has('P')))
    place_.fail("turning cycles (G70, G71) are not read; alone, " + nc_code_name('G', units) +
                " says inches or millimetres");
  std::int16_t& motion = codes_[static_cast<std::size_t>(NcGroup::Motion)];
  if ((motion == 50 || motion == 51) && !has_axes() && !has('I') && !has('J') && (has('P') || has('Q'))) {
    motion = -1;
    pass_over("PQR");
  }
  if (code(NcGroup::LatheRadius) == 80) pass_over("P");
}

void NcWords::add_code(char letter, double value) {
  const double tenths = std::round(value * 10);
  const CodeTable& table = letter == 'G' ? kG : kM;
  std::int8_t group = kUnknown;
  if (tenths >= 0 && tenths < static_cast<double>(table.size()) && std::abs(value * 10 - tenths) < 1e-9)
    group = table[static_cast<std::size_t>(tenths)];
  if (group == kUnknown) {
    char text[64];
    std::snprintf(text, sizeof text, "%c%.10g", letter, value);
    if (const char* why = never_skipped(letter, value))
      place_.fail(std::string(text) + " is not read: " + why +
                  " would move what follows; have the CAM system write the program without");
    skip_code(letter, text);
    return;
  }
  std::int16_t& slot = codes_[static_cast<std::size_t>(group)];
  const int number = static_cast<int>(tenths);
  if (slot == number) place_.fail(nc_code_name(letter, number) + " twice in one block");
  // G80 next to a motion cancels nothing, as in LinuxCNC: headers list it among the modes.
  if (static_cast<NcGroup>(group) == NcGroup::Motion && slot >= 0 && (slot == 800 || number == 800)) {
    if (slot == 800) slot = static_cast<std::int16_t>(number);
    return;
  }
  if (static_cast<NcGroup>(group) == NcGroup::Off) {
    slot = static_cast<std::int16_t>(number);  // headers combine G50 G69 G15
    return;
  }
  if (slot >= 0)
    place_.fail((static_cast<NcGroup>(group) == NcGroup::Motion ? "two motions in one block: "
                                                                : "codes that contradict each other: ") +
                nc_code_name(letter, slot) + " and " + nc_code_name(letter, number));
  slot = static_cast<std::int16_t>(number);
  groups_ |= 1U << group;
}

/// Skips a word. For an axis that the machine does not have, the coordinate is lost.
void NcWords::skip_letter(char letter) {
  const std::string shown = std::string("letter ") + letter;
  const bool rotary = letter <= 'C', linear = letter >= 'U' && letter <= 'W';
  if (!skip_ && rotary) {
    const std::string others = machines_with(letter);
    place_.fail("unknown " + shown + ": the machine has no such axis" +
                (others.empty() ? "; describe one that does" : "; these have: " + others));
  }
  if (!skip_ && linear)
    place_.fail("unknown " + shown + ": second linear axes are not read; have the CAM system write X, Y and Z alone");
  if (!skip_) place_.fail("unknown " + shown + kAdvice);
  skip_->push_back(std::string(1, letter));
  if (rotary || linear) lost_axes_ = true;
}

void NcWords::skip_code(char letter, const std::string& shown) {
  if (!skip_) place_.fail("unknown code " + shown + kAdvice);
  skip_->push_back(shown);
  skipped_ = true;
  if (letter == 'G') skipped_g_ = true;
}

/// Skips the words that an unknown code may own: for a G code also the axis words, if the block has no motion of its
/// own. An M code owns none.
void NcWords::take_skipped_words() {
  constexpr std::string_view kOwn = "DEHIJKLPQR";
  const bool moves = code(NcGroup::Motion) >= 0;
  const bool codes_with_words = moves || code(NcGroup::NonModal) >= 0 || code(NcGroup::ToolLength) >= 0;
  if (codes_with_words || !skipped_g_) {
    pass_over(kOwn);
    return;
  }
  for (const char letter : kOwn) given_ &= ~bit(letter);
  lost_axes_ = lost_axes_ || has_axes();
  given_ &= ~axis_bits_;
}

int NcWords::whole(char letter) {
  const double v = value(letter, kMaxNumber);
  // An integer up to the rounding of an expression counts as that integer, as in LinuxCNC.
  if (v < -1e-4 || std::abs(v - std::round(v)) > 1e-4) place_.fail(std::string(1, letter) + " must be a whole number");
  return static_cast<int>(std::round(v));
}

void NcWords::pass_over(std::string_view letters) {
  for (const char letter : letters) used_ |= bit(letter);
}

void NcWords::fail_range(char letter) const {
  place_.fail(std::string(1, letter) + " is out of range");
}

void NcWords::fail_unused() const {
  char letter = 'A';
  while (!(given_ & ~used_ & bit(letter))) ++letter;
  place_.fail(std::string(1, letter) + " has no meaning in this block");
}

}  // namespace riffler::nc
