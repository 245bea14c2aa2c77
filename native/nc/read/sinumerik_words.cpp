#include "nc/read/sinumerik_words.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "nc/limits.hpp"
#include "nc/machine/machine.hpp"

namespace riffler::nc {

namespace {

struct MeaningName {
  std::string_view name;
  SinumerikCoordinate::Meaning meaning;
};
constexpr MeaningName kMeanings[] = {
    {"AC", SinumerikCoordinate::Meaning::Absolute},  {"IC", SinumerikCoordinate::Meaning::Incremental},
    {"DC", SinumerikCoordinate::Meaning::Shortest},  {"ACP", SinumerikCoordinate::Meaning::Positive},
    {"ACN", SinumerikCoordinate::Meaning::Negative},
};

/// Parameters without motion: smoothing of the path, and feeds in corners.
constexpr std::string_view kQuietParameters[] = {"ADIS",  "ADISPOS", "CTOL",    "OTOL",   "ATOL",
                                                 "STOLF", "DISC",    "FRC",     "FRCM",   "OVR",
                                                 "LIMS",  "OVRRAP",  "ACCLIMA", "FPRAON", "COMPTOL"};
/// Parameters that a program may reset to 0, but that would otherwise change the tool path.
constexpr std::string_view kPathParameters[] = {"CHF", "CHR", "RND", "RNDM", "OFFN", "LEAD", "TILT", "TCARR", "THETA"};

bool names_axis(char c) {
  return kJointLetters.find(c) != kJointLetters.npos;
}

template <std::size_t N>
bool is_one_of(const std::string& name, const std::string_view (&names)[N]) {
  return std::ranges::find(names, name) != std::end(names);
}

}  // namespace

bool SinumerikWords::has_code(int code) const {
  return std::ranges::find(codes, code) != codes.end();
}

bool SinumerikWords::empty() const {
  const bool moves = has_linear() || has_rotary() || has_centre() || has_vector() || radius || opening || turns;
  return !moves && !feed && !block_feed && !speed && !tool && tool_name.empty() && !edge && !call && codes.empty() &&
         functions.empty();
}

void SinumerikWords::read(SinumerikCursor& cursor, SinumerikValues& values, const Other& other) {
  while (cursor.peek() != '\0') {
    if (cursor.at_address())
      take_address(cursor, values);
    else
      take_name(cursor, values, other);
  }
}

void SinumerikWords::once(std::optional<double>& to, double value, const std::string& name, SinumerikCursor& cursor) {
  if (to) cursor.fail(name + " twice in one block");
  to = value;
}

/// "X10", "X=R1", "X1=10", "R1=5".
void SinumerikWords::take_address(SinumerikCursor& cursor, SinumerikValues& values) {
  const char letter = cursor.peek();
  cursor.take();
  SinumerikCursor ahead = cursor;
  const std::string extension = ahead.digits();
  if (ahead.peek() == '=' && !ahead.take_if("==")) {
    ahead.take();
    cursor = ahead;
    return take_extended(letter, extension, cursor, values);
  }
  const std::string name(1, letter);
  if (letter == 'R' && cursor.peek() == '[') {
    const std::string element = values.element(name, cursor);
    if (!cursor.take_if("=")) cursor.fail("R[...] without =");
    return values.assign(element, cursor);
  }
  const double sign = cursor.take_if("-") ? -1 : (cursor.take_if("+"), 1);
  if (names_axis(letter))
    axes[joint_index(letter)].given
        ? cursor.fail(name + " twice in one block")
        : void(axes[joint_index(letter)] = {sign * cursor.number(name), SinumerikCoordinate::Meaning::Modal, true});
  else
    take_number(letter, sign * cursor.number(name), cursor);
}

void SinumerikWords::take_extended(char letter, const std::string& extension, SinumerikCursor& cursor,
                                   SinumerikValues& values) {
  const std::string name = std::string(1, letter) + extension;
  if (letter == 'R' && !extension.empty()) return values.assign(values.element(name, cursor), cursor);
  if (extension.empty() && letter == 'T' && cursor.peek() == '"') {
    tool_name = cursor.quoted();
    return;
  }
  if (extension.empty() && letter == 'T') {
    SinumerikCursor ahead = cursor;
    if (const auto text = values.text(ahead.name())) {
      cursor = ahead;
      tool_name = *text;
      return;
    }
  }
  if (names_axis(letter) && extension.empty()) return take_coordinate(axes[joint_index(letter)], name, cursor, values);
  if (names_axis(letter) && extension == "1" && letter >= 'X') {
    homes = true;
    return take_coordinate(axes[joint_index(letter)], name, cursor, values);
  }
  if (letter >= 'I' && letter <= 'K' && extension.size() <= 1 && (extension.empty() || extension == "1"))
    return take_coordinate((extension.empty() ? centre : via)[static_cast<std::size_t>(letter - 'I')], name, cursor,
                           values);
  const double value = values.value(cursor, name);
  if (letter >= 'A' && letter <= 'C' && extension == "3") {
    std::optional<double>& to = vector[static_cast<std::size_t>(letter - 'A')];
    return once(to, value, name, cursor);
  }
  if (letter >= 'A' && letter <= 'C')
    cursor.fail(name + "= is not read: have the post write the tool's axis as A3= B3= C3=, or the rotary axes");
  if (letter == 'M' || letter == 'S') {
    const int spindle = extension.empty() ? 0 : std::stoi(extension.substr(0, 3));
    if (letter == 'S' && spindle > 1) return;  // another spindle
    if (letter == 'S') return once(speed, value, "S", cursor);
    if (!(value >= 0 && value <= kMaxNumber && value == std::floor(value))) cursor.fail("there is no such M function");
    functions.push_back({static_cast<int>(value), spindle});
    return;
  }
  if (letter == 'H') return;  // for the machine's PLC
  if (!extension.empty() && letter != 'T') cursor.fail("unknown word " + name + "=: correct it, or take it out");
  take_number(letter, value, cursor);
}

void SinumerikWords::take_number(char letter, double value, SinumerikCursor& cursor) {
  const std::string name(1, letter);
  const auto whole = [&](int most) {
    if (!(value >= 0 && value <= most && value == std::floor(value)))
      cursor.fail(name + " takes a whole number, not negative");
    return static_cast<int>(value);
  };
  switch (letter) {
    case 'G':
      codes.push_back(whole(999));
      return;
    case 'M':
      functions.push_back({whole(kMaxNumber), 0});
      // Arguments of a machine function. The functions of every control have two-digit numbers.
      if (value > 99 && cursor.take_if("(")) cursor.skip_brackets();
      return;
    case 'F':
      return once(feed, value, name, cursor);
    case 'S':
      return once(speed, value, name, cursor);
    case 'I':
    case 'J':
    case 'K': {
      SinumerikCoordinate& to = centre[static_cast<std::size_t>(letter - 'I')];
      if (to.given) cursor.fail(name + " twice in one block");
      to = {value, SinumerikCoordinate::Meaning::Modal, true};
      return;
    }
    case 'T':
      tool = whole(kMaxNumber);
      return;
    case 'D':
      edge = whole(kMaxNumber);
      return;
    case 'L':
      call = whole(kMaxNumber);
      return;
    case 'P':
      times = whole(kMaxNumber);
      return;
    case 'H':
      return;
    case 'U':
    case 'V':
    case 'W':
      cursor.fail("unknown letter " + name +
                  ": second linear axes are not read; have the CAM system write X, Y and Z alone");
    default:
      cursor.fail("unknown letter " + name + ": correct it, or take it out");
  }
}

void SinumerikWords::take_coordinate(SinumerikCoordinate& to, const std::string& name, SinumerikCursor& cursor,
                                     SinumerikValues& values) {
  if (to.given) cursor.fail(name + " twice in one block");
  for (const MeaningName& meaning : kMeanings) {
    SinumerikCursor ahead = cursor;
    if (ahead.name() != meaning.name || !ahead.take_if("(")) continue;
    cursor = ahead;
    to = {values.value(cursor, name), meaning.meaning, true};
    if (!cursor.take_if(")")) cursor.fail("a bracket that is not closed");
    return;
  }
  to = {values.value(cursor, name), SinumerikCoordinate::Meaning::Modal, true};
}

/// Parameters with names of several letters, variables, and names handled by `other`.
void SinumerikWords::take_name(SinumerikCursor& cursor, SinumerikValues& values, const Other& other) {
  SinumerikCursor ahead = cursor;
  const std::string name = ahead.name();
  if (name.empty()) cursor.fail_unexpected();
  SinumerikCursor after = ahead;
  if (after.take_if("[")) after.skip_brackets();
  const bool assigns = after.peek() == '=';
  if (!assigns) {
    cursor = ahead;
    return other(name, cursor);
  }
  if (values.knows(name)) {
    cursor = ahead;
    const std::string element = values.element(name, cursor);
    if (!cursor.take_if("=")) cursor.fail_unexpected();
    return values.assign(element, cursor);
  }
  cursor = after;
  cursor.take();
  take_parameter(name, cursor, values);
}

void SinumerikWords::take_parameter(const std::string& name, SinumerikCursor& cursor, SinumerikValues& values) {
  if (name == "CR") return once(radius, values.value(cursor, name), name, cursor);
  if (name == "AR") return once(opening, values.value(cursor, name), name, cursor);
  if (name == "TURN") return once(turns, values.value(cursor, name), name, cursor);
  if (name == "RPL") return once(plane_angle, values.value(cursor, name), name, cursor);
  if (name == "FB") return once(block_feed, values.value(cursor, name), name, cursor);
  if (name == "SPOS" || name == "SPOSA") {  // the spindle stops
    SinumerikCoordinate angle;
    take_coordinate(angle, name, cursor, values);
    functions.push_back({19, 0});
    return;
  }
  if (is_one_of(name, kQuietParameters) || name == "FGREF" || name == "FA" || name == "FL" || name == "ACC" ||
      name == "VELOLIM" || name == "ACCLIM" || name == "JERKLIM") {
    values.expression(cursor);
    return;
  }
  if (name.starts_with("$TC_") || name.starts_with("$AC_TIMER") || name.starts_with("$AC_MARKER") ||
      name.starts_with("$A_OUT") || name.starts_with("$A_DB")) {  // tool table, clocks, signals
    values.expression(cursor);
    return;
  }
  if (is_one_of(name, kPathParameters)) {
    if (values.value(cursor, name) != 0)
      cursor.fail(name + "= is not read: it changes the tool's path; have the CAM system write the moves");
    return;
  }
  if (name[0] == '$')
    cursor.fail("the system variable " + name +
                " is assigned to, which may move what follows: have the CAM system write TRANS and AROT, or take it "
                "out");
  if (name == "POS" || name == "POSA" || name == "POSP" || name == "AP" || name == "RP" || name == "ANG" ||
      name == "MEAS" || name == "MEAW")
    cursor.fail(name + "= is not read: it moves the tool; have the CAM system write G1 with X Y Z");
  cursor.fail(name + " is not defined: correct it, or DEF REAL " + name + " at the beginning of the program");
}

}  // namespace riffler::nc
