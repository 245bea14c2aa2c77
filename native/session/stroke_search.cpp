#include "session/stroke_search.hpp"

#include <string>
#include <utility>

namespace riffler::session {
namespace {

bool sweeps(StrokeMode mode) {
  return mode == StrokeMode::Remove || mode == StrokeMode::Beside || mode == StrokeMode::Add ||
         mode == StrokeMode::Build;
}

}  // namespace

sweep::CutSearch stroke_search(const Journal& journal, const std::map<int, Tool>& tools, double tolerance) {
  std::vector<Tool> shapes;
  std::map<int, std::uint32_t> place;
  for (const auto& [number, tool] : tools) {
    place.emplace(number, static_cast<std::uint32_t>(shapes.size()));
    tool.require_revolved("tool " + std::to_string(number) + ": the search for the stroke that made a surface");
    shapes.push_back(tool);
  }
  std::vector<sweep::SearchedMove> moves;
  std::int32_t id = 0;
  for (const JournalStroke& stroke : journal.strokes()) {
    for (std::size_t row = 1; sweeps(stroke.mode) && row < stroke.poses.size(); ++row)
      moves.push_back({stroke.poses[row - 1], stroke.poses[row], place.at(stroke.tool), id});
    ++id;
  }
  return {std::move(shapes), std::move(moves), tolerance};
}

}  // namespace riffler::session
