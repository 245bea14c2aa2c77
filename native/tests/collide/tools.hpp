// Tools for the tests of contact: every named cutter, with shank and holder and without, and odd ones.
#pragma once

#include <vector>

#include "riffler/tool/cutters.hpp"

namespace riffler::collide {

inline Tool held(const Tool& cutter) {
  const double l = cutter.length(), r = 0.5 * cutter.diameter();
  return cutter.with_shank({{l, r, l + 15, r}, {l + 15, r, l + 30, 8}}).with_holder({{l + 30, 20, l + 60, 20}});
}

inline std::vector<Tool> contact_tools() {
  std::vector<Tool> out{cutters::ball(6, 30),
                        cutters::flat(6, 30),
                        cutters::fillet(8, 1, 30),
                        cutters::taper(0.5, 0.2, 8, 40),
                        cutters::taper(1, 0.4, 8, 40, true),
                        cutters::cone_end(1.0, 1, 0.4, 8, 40)};
  for (std::size_t i = 0, n = out.size(); i < n; ++i) out.push_back(held(out[i]));
  // A hollow; a disc on a neck; a gap between cutter and holder; a shank thinner than the cutter that overlaps it, and
  // one that is wider and narrows.
  out.push_back(cutters::profile({{{1, 0}, {}}, {{1, 1}, {}}, {{4, 4}, Vec2(4, 1)}}, 12));
  out.push_back(cutters::profile({{{6, 0}, {}}, {{6, 2}, {}}, {{2, 2}, {}}}, 20));
  out.push_back(cutters::ball(6, 10).with_holder({{14, 10, 20, 12}}));
  out.push_back(cutters::ball(6, 20).with_shank({{18, 2, 30, 2}, {24, 0.5, 34, 6}}).with_holder({{34, 9, 44, 3}}));
  return out;
}

}  // namespace riffler::collide
