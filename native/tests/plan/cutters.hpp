// Every named cutter, for tests that must hold for all of them.
#pragma once

#include <cmath>
#include <vector>

#include "riffler/tool/cutters.hpp"

namespace riffler::plan {

inline std::vector<Tool> named_cutters() {
  return {cutters::ball(6, 30).named("ball"),
          cutters::flat(6, 30).named("flat"),
          cutters::fillet(8, 1, 30).named("fillet"),
          cutters::fillet(8, 4, 30).named("fillet that is a ball"),
          cutters::taper(0.5, 0.2, 8, 40).named("taper"),
          cutters::taper(1, 0.4, 8, 40, true).named("taper, flat tip"),
          cutters::taper(0, 0.7, 8, 40).named("taper, sharp tip"),
          cutters::cone_end(1.0, 1, 0.4, 8, 40).named("cone end"),
          cutters::cone_end(0.3, 4, 0.9, 8, 40).named("cone end that widens late"),
          cutters::profile({{{1, 0}, {}}, {{std::sqrt(52) - 5, 4}, Vec2(-5, 4)}}, 20).named("barrel"),
          cutters::profile({{{1, 0}, {}}, {{1, 1}, {}}, {{4, 4}, Vec2(4, 1)}}, 12).named("hollow"),
          cutters::profile({{{6, 0}, {}}, {{6, 2}, {}}, {{2, 2}, {}}}, 20).named("disc on a neck")};
}

}  // namespace riffler::plan
