#include "plan/finish/patterns.hpp"

#include <algorithm>

namespace riffler::plan {

const std::vector<Pattern>& patterns() {
  static const std::vector<Pattern> table{
      {"parallel", &parallel_rows}, {"waterline", &waterline_rows}, {"scallop", &scallop_rows},
      {"spiral", &spiral_rows},     {"radial", &radial_rows},
  };
  return table;
}

void add_blocked(const std::vector<BlockedPlace>& more, std::vector<BlockedPlace>& all) {
  for (const BlockedPlace& one : more) {
    const auto same =
        std::find_if(all.begin(), all.end(), [&](const BlockedPlace& b) { return b.reason == one.reason; });
    if (same == all.end())
      all.push_back(one);
    else
      same->length += one.length;
  }
}

std::vector<std::string> finish_patterns() {
  std::vector<std::string> out;
  for (const Pattern& one : patterns()) out.emplace_back(one.name);
  return out;
}

}  // namespace riffler::plan
