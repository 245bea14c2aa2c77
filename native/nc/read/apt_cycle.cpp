#include "nc/read/apt_cycle.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "nc/limits.hpp"
#include "nc/read/drill_cycle.hpp"

namespace riffler::nc {

namespace {

constexpr double kMaxPecks = 100'000;

/// Lengths and feeds in pairs of a word and its number.
void take_words(AptCycle& cycle, const AptStatement& statement, const AptLexer& lexer, double unit,
                const NcPlace& place) {
  bool retracts = false, feeds = false;
  for (std::size_t k = 1; k < statement.words.size(); k += 2) {
    const std::string& word = statement.words[k];
    if (word == "DEEP" && k == 1) {
      --k;  // DEEP after DRILL has no number
      continue;
    }
    const std::optional<double> number =
        k + 1 < statement.words.size() ? lexer.number(statement.words[k + 1]) : std::nullopt;
    if (lexer.number(word))
      place.fail(
          "CYCLE with numbers alone: only one post processor knows their meaning; have the CAM system write FEDTO, "
          "RAPTO and RTRCTO, or the moves");
    if (!number) place.fail("CYCLE: " + word + " without a number");
    const double length = *number * unit;
    if (!(std::abs(length) <= kMaxLength)) place.fail("CYCLE: " + word + " is out of range");
    if (word == "FEDTO")
      cycle.depth = length, feeds = true;
    else if (word == "RAPTO")
      cycle.clearance = length;
    else if (word == "RTRCTO")
      cycle.retract = length, retracts = true;
    else if (word == "1STPECK")
      cycle.first_peck = length;
    else if (word == "SUBPECK" || word == "INCR")
      cycle.peck = length;
    else if (word == "MMPM" || word == "IPM")
      cycle.feed = *number * (word == "IPM" ? kInch : 1);
    else if (word != "DWELL")
      place.fail("CYCLE: unknown word " + word);
  }
  if (!retracts) cycle.retract = cycle.clearance;
  if (!feeds || cycle.depth < 0) place.fail("CYCLE needs FEDTO, its depth below the point");
}

}  // namespace

std::optional<AptCycle> apt_cycle(const AptStatement& statement, const AptLexer& lexer, double unit,
                                  const NcPlace& place) {
  if (statement.words.empty()) place.fail("CYCLE without a word");
  const std::string& kind = statement.words[0];
  if (kind == "OFF" || kind == "INIT" || kind == "ON") return std::nullopt;
  const bool pecks = kind == "DEEP" || kind == "DEEP2", feeds_out = kind == "TAP" || kind == "REAM" || kind == "BORE";
  if (!pecks && !feeds_out && kind != "DRILL" && kind != "FACE")
    place.fail("CYCLE/" + kind +
               " is not read: DRILL, FACE, DEEP, TAP, REAM and BORE are; have the CAM system write its "
               "moves");
  AptCycle cycle;
  cycle.feeds_out = feeds_out;
  take_words(cycle, statement, lexer, unit, place);
  if (!(cycle.clearance >= 0 && cycle.retract >= 0)) place.fail("CYCLE: RAPTO and RTRCTO lie above the point");
  if (!(cycle.feed >= 0 && cycle.feed <= kMaxFeed)) place.fail("CYCLE: its feed is out of range");
  if (!pecks) {
    cycle.first_peck = cycle.peck = 0;
    return cycle;
  }
  if (cycle.first_peck == 0) cycle.first_peck = cycle.peck;
  if (cycle.peck == 0) cycle.peck = cycle.first_peck;
  if (!(cycle.peck > 0 && cycle.first_peck > 0)) place.fail("CYCLE/" + kind + " needs the depth of a peck, INCR");
  if (!(cycle.depth / cycle.peck <= kMaxPecks)) place.fail("CYCLE: too many pecks");
  return cycle;
}

void apt_cycle_moves(const AptCycle& cycle, const Pose& point, const std::function<void(const Pose&, bool)>& move) {
  const auto go = [&](double height, bool rapid) { move({point.tip + height * point.axis, point.axis}, rapid); };
  const double above = std::max(cycle.retract, cycle.clearance);
  go(above, true);
  if (cycle.clearance < above) go(cycle.clearance, true);
  if (cycle.first_peck > 0)
    for (double depth = cycle.first_peck; depth < cycle.depth; depth += cycle.peck) {
      go(-depth, false);
      go(cycle.clearance, true);
      go(std::min(-depth + kPeckClearance, cycle.clearance), true);
    }
  go(-cycle.depth, false);
  if (cycle.feeds_out) go(cycle.clearance, false);
  if (!cycle.feeds_out || cycle.retract != cycle.clearance) go(cycle.retract, true);
}

}  // namespace riffler::nc
