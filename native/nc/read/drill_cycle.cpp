#include "nc/read/drill_cycle.hpp"

namespace riffler::nc {

namespace {

constexpr double kMaxPecks = 100'000;

}  // namespace

bool is_drill_cycle(int code) {
  switch (code) {
    case 730:
    case 740:
    case 810:
    case 820:
    case 830:
    case 840:
    case 850:
    case 860:
    case 890:
      return true;
    default:
      return false;
  }
}

bool is_tapping_cycle(int code) {
  return code == 740 || code == 840;
}

void drill(const DrillCycle& cycle, const NcPlace& place, const std::function<void(double, bool)>& move) {
  const bool taps = is_tapping_cycle(cycle.code);
  if (cycle.peck > 0 && (taps || cycle.code == 730 || cycle.code == 830)) {
    if (!((cycle.retract - cycle.bottom) / cycle.peck <= kMaxPecks)) place.fail("Q is too small: too many pecks");
    for (double depth = cycle.retract - cycle.peck; depth > cycle.bottom; depth -= cycle.peck) {
      move(depth, false);
      if (taps) {
        move(cycle.retract, false);
        continue;
      }
      if (cycle.code == 830) move(cycle.retract, true);
      move(depth + kPeckClearance, true);
    }
  }
  move(cycle.bottom, false);
  if (cycle.code == 890) {
    move(cycle.clear, false);
  } else {
    const bool feeds_out = taps || cycle.code == 850;
    if (feeds_out) move(cycle.retract, false);
    if (!feeds_out || cycle.clear != cycle.retract) move(cycle.clear, true);
  }
}

}  // namespace riffler::nc
