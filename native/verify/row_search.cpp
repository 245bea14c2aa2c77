#include "verify/row_search.hpp"

#include <utility>

#include "nc/follow.hpp"
#include "verify/toolset.hpp"

namespace riffler::verify {

sweep::CutSearch row_search(const nc::Program& program, std::map<int, Tool> own, double tolerance) {
  nc::RowMap map;
  const nc::Program rows = nc::followed(program, &map);
  constexpr double kCutting = 0.01;  // mm: tolerance of shapes that are not used here
  Toolset tools(std::move(own), kCutting, 0, 1);
  const std::vector<std::uint32_t> places = tools.places(rows, 0);
  std::vector<sweep::SearchedMove> moves;
  for (std::size_t row = 1; row < rows.size(); ++row)
    if (places[row] != kNoTool)
      moves.push_back({rows.poses()[row - 1], rows.poses()[row], places[row],
                       static_cast<std::int32_t>(map.empty() ? row : map.original(row))});
  return {tools.tools(), std::move(moves), tolerance};
}

}  // namespace riffler::verify
