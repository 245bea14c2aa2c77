#include "verify/slab_job.hpp"

#include <algorithm>

namespace riffler::verify {

void SlabState::save(std::int64_t row, const SlabTiles& now) {
  if (++since < spacing) return;
  since = 0;
  snapshots.push_back({row, now});
  if (snapshots.size() <= kMaxSnapshots) return;
  std::vector<SlabSnapshot> fewer;
  for (std::size_t k = 0; k < snapshots.size(); k += 2) fewer.push_back(std::move(snapshots[k]));
  snapshots = std::move(fewer);
  spacing *= 2;
}

void SlabState::rewind(std::int64_t row) {
  while (snapshots.size() > 1 && snapshots.back().row >= row) snapshots.pop_back();
  const SlabSnapshot& start = snapshots.back();
  done = start.row, tiles = start.tiles, since = 0;
  const auto later = [&](std::int64_t r) { return r > done; };
  std::erase_if(report.removed, [&](const auto& entry) { return later(entry.first); });
  // What the stock lacks from the start has row 0.
  std::erase_if(report.events, [&](const Event& e) { return later(e.row); });
  report.strikes = static_cast<std::uint64_t>(std::count_if(report.events.begin(), report.events.end(), is_strike));
}

void SlabState::renumber(std::int64_t from, std::int64_t shift) {
  if (shift == 0) return;
  for (auto& [row, taken] : report.removed) row += row >= from ? shift : 0;
  for (Event& e : report.events) e.row += e.row >= from ? shift : 0;
  for (SlabSnapshot& s : snapshots) s.row += s.row >= from ? shift : 0;
}

}  // namespace riffler::verify
