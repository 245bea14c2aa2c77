#include "nc/words.hpp"

#include <cmath>
#include <cstdio>
#include <optional>

#include "nc/limits.hpp"

namespace riffler {

namespace {

std::optional<NcGroup> g_group(int tenths) {
  switch (tenths) {
    case 0:
    case 10:
    case 20:
    case 30:
    case 800:
      return NcGroup::Motion;
    case 40:
      return NcGroup::NonModal;
    case 170:
    case 180:
    case 190:
      return NcGroup::Plane;
    case 200:
    case 210:
      return NcGroup::Units;
    case 400:
      return NcGroup::CutterCompensation;
    case 430:
    case 434:
    case 490:
      return NcGroup::ToolLength;
    case 540:
      return NcGroup::WorkOffset;
    case 610:
    case 611:
    case 640:
      return NcGroup::PathControl;
    case 900:
    case 910:
      return NcGroup::Distance;
    case 901:
    case 911:
      return NcGroup::ArcDistance;
    case 930:
    case 940:
      return NcGroup::FeedMode;
    case 980:
    case 990:
      return NcGroup::ReturnLevel;
    default:
      return std::nullopt;
  }
}

std::optional<NcGroup> m_group(int tenths) {
  switch (tenths) {
    case 0:
    case 10:
    case 20:
    case 300:
      return NcGroup::Stop;
    case 30:
    case 40:
    case 50:
      return NcGroup::Spindle;
    case 60:
      return NcGroup::ToolChange;
    case 70:
      return NcGroup::Mist;
    case 80:
    case 90:
      return NcGroup::Flood;
    default:
      return std::nullopt;
  }
}

/// "G43.4" for 'G' and 434.
std::string show(char letter, int tenths) {
  char text[32];
  std::snprintf(text, sizeof text, tenths % 10 ? "%c%d.%d" : "%c%d", letter, tenths / 10, tenths % 10);
  return text;
}

}  // namespace

void NcWords::collect(const NcBlock& block) {
  constexpr std::string_view kWords = "FHIJKNOPQRSTXYZ";
  given_ = used_ = 0;
  codes_.fill(-1);
  for (std::size_t k = 0; k < block.words.size(); ++k) {
    const auto [letter, value] = block.words[k];
    if (letter == 'G' || letter == 'M') {
      add_code(letter, value);
      continue;
    }
    if (kWords.find(letter) == kWords.npos && axes_.find(letter) == axes_.npos) fail_unknown(letter);
    if (letter == 'N' && k > 0) lexer_.fail("N must be first in its block");
    if (has(letter)) lexer_.fail(std::string(1, letter) + " twice in one block");
    given_ |= bit(letter);
    values_[static_cast<std::size_t>(letter - 'A')] = value;
  }
}

void NcWords::fail_unknown(char letter) const {
  const std::string shown(1, letter);
  if (letter >= 'A' && letter <= 'C') lexer_.fail("unknown letter " + shown + ": the machine has no such axis");
  lexer_.fail("unknown letter " + shown);
}

void NcWords::add_code(char letter, double value) {
  const double tenths = std::round(value * 10);
  std::optional<NcGroup> group;
  if (value >= 0 && value < 1000 && std::abs(value * 10 - tenths) < 1e-9)
    group = letter == 'G' ? g_group(static_cast<int>(tenths)) : m_group(static_cast<int>(tenths));
  if (!group) {
    char text[64];
    std::snprintf(text, sizeof text, "unknown code %c%.10g", letter, value);
    lexer_.fail(text);
  }
  int& slot = codes_[static_cast<std::size_t>(*group)];
  const int number = static_cast<int>(tenths);
  if (slot == number) lexer_.fail(show(letter, number) + " twice in one block");
  if (slot >= 0)
    lexer_.fail((group == NcGroup::Motion ? "two motions in one block: " : "codes that contradict each other: ") +
                show(letter, slot) + " and " + show(letter, number));
  slot = number;
}

double NcWords::value(char letter, double limit) {
  used_ |= bit(letter);
  const double v = values_[static_cast<std::size_t>(letter - 'A')];
  if (!(std::abs(v) <= limit)) lexer_.fail(std::string(1, letter) + " is out of range");
  return v;
}

int NcWords::whole(char letter) {
  const double v = value(letter, kMaxNumber);
  if (v < 0 || v != std::floor(v)) lexer_.fail(std::string(1, letter) + " must be a whole number");
  return static_cast<int>(v);
}

void NcWords::check_all_used() const {
  const std::uint32_t idle = given_ & ~used_;
  for (char letter = 'A'; letter <= 'Z'; ++letter)
    if (idle & bit(letter)) lexer_.fail(std::string(1, letter) + " has no meaning in this block");
}

}  // namespace riffler
