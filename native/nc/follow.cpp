#include "nc/follow.hpp"

#include <algorithm>

namespace riffler::nc {

void RowMap::add(std::size_t row, std::size_t count) {
  const std::size_t before = ends_.empty() ? 0 : ends_.back().second;
  ends_.emplace_back(row + before + count, before + count);
}

std::size_t RowMap::original(std::size_t followed) const {
  const auto next = std::ranges::lower_bound(ends_, followed, {}, [](const auto& end) { return end.first; });
  const std::size_t before = next == ends_.begin() ? 0 : std::prev(next)->second;
  if (next == ends_.end()) return followed - before;
  const std::size_t row = next->first - next->second;
  return std::min(followed - before, row);
}

std::vector<double> RowMap::sums(const std::vector<double>& followed) const {
  if (followed.empty()) return {};
  std::vector<double> out(original(followed.size() - 1) + 1);
  for (std::size_t k = 0; k < followed.size(); ++k) out[original(k)] += followed[k];
  return out;
}

Program followed(const Program& program, RowMap* map, std::size_t first_row) {
  Program out;
  out.reserve(program.size());
  for (std::size_t row = 0; row < program.size(); ++row) {
    Move move = program[row];
    if (const std::shared_ptr<const std::vector<Pose>> via = std::exchange(move.via, nullptr)) {
      Move on_the_way = move;
      for (const Pose& pose : *via) {
        on_the_way.pose = pose;
        out.append(on_the_way);
      }
      if (map) map->add(first_row + row, via->size());
    }
    out.append(move);
  }
  out.tools = program.tools, out.provenance = program.provenance, out.notes = program.notes;
  return out;
}

const Program& FollowedChunks::follow(const Program& chunk) {
  next_rows_ = rows_ + chunk.size() - (rows_ > 0 ? 1 : 0);
  next_map_ = map_;
  if (chunk.via().empty()) return chunk;
  whole_ = followed(chunk, &next_map_, rows_ > 0 ? rows_ - 1 : 0);
  return whole_;
}

void FollowedChunks::taken() {
  map_ = std::move(next_map_), rows_ = next_rows_;
}

}  // namespace riffler::nc
