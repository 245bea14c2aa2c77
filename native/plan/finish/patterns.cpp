#include "plan/finish/patterns.hpp"

namespace riffler::plan {

const std::vector<Pattern>& patterns() {
  static const std::vector<Pattern> table{
      {"parallel", &parallel_rows},
  };
  return table;
}

std::vector<std::string> finish_patterns() {
  std::vector<std::string> out;
  for (const Pattern& one : patterns()) out.emplace_back(one.name);
  return out;
}

}  // namespace riffler::plan
