#include "verify/remote.hpp"

#include <algorithm>
#include <stdexcept>

#include "base/freed_memory.hpp"
#include "riffler/base/parallel.hpp"
#include "verify/simulate.hpp"

namespace riffler::verify {

SlabWorker::SlabWorker(std::span<const std::uint8_t> context) : context_(context_of(context)) {
  // Dask starts its workers with MALLOC_TRIM_THRESHOLD_=65536: freed memory goes back to the system at once, and glibc
  // no longer adapts to large temporary arrays, so each array over 128 kB is mapped again. The page faults take as long
  // as the simulation.
  base::reuse_freed_memory();
  if (context_.frames.empty()) throw std::invalid_argument("context: there is no stock");
  for (const Tool& tool : context_.tools)
    shapes_.emplace_back(tool, context_.tolerance, context_.reach, context_.frames[0].pitch);
  for (const dexel::Frame& frame : context_.frames) {
    // Not a Volume: all its rays might not fit into the memory of this machine.
    std::vector<dexel::Grid>& grids = grids_.emplace_back();
    const std::vector<Axis> axes = dexel::parse_directions(frame.directions);
    for (const Axis axis : axes) grids.emplace_back(axis, frame.box, frame.pitch, axes.size() == 3);
  }
  if (context_.part) surface_.emplace(*context_.part, context_.gouge_tolerance);
}

const dexel::Grid& SlabWorker::grid_of(const SlabTask& task) const {
  const auto frame = static_cast<std::size_t>(task.fixture + 1);
  if (task.fixture < -1 || frame >= grids_.size() || task.slab.grid >= grids_[frame].size())
    throw std::invalid_argument("task: a slab of another verification");
  const dexel::Grid& grid = grids_[frame][task.slab.grid];
  const Slab& s = task.slab;
  const auto within = [](int a, int b, int end) { return 0 <= a && a < b && b <= end; };
  if (!within(s.u0, s.u1, grid.tiles_u()) || !within(s.v0, s.v1, grid.tiles_v()) || s.tile_count() != task.tiles.size())
    throw std::invalid_argument("task: a slab of another verification");
  return grid;
}

std::vector<std::uint8_t> SlabWorker::run(std::span<const std::uint8_t> task,
                                          std::span<const std::span<const std::uint8_t>> moves) const {
  const base::SerialScope alone;  // the cluster decides how many slabs run at once
  SlabTask at = task_of(task);
  const dexel::Grid& grid = grid_of(at);
  const bool judged = surface_ && at.fixture < 0;
  if (std::ranges::count(at.tiles, nullptr) > 0 || std::ranges::count(at.part, nullptr) > 0 ||
      at.part.size() != (judged ? at.tiles.size() : 0))
    throw std::invalid_argument("task: a slab of another verification");
  SlabMoves given;
  for (const std::span<const std::uint8_t> packet : moves) add_moves(packet, given);
  if (std::ranges::any_of(given.tool, [&](std::uint32_t tool) { return tool >= shapes_.size(); }))
    throw std::invalid_argument("moves: of another verification");
  Moves ready(given.poses, 2, shapes_, context_.top);
  for (std::size_t i = 0; i < given.row.size(); ++i) ready.add(given.row[i], given.tool[i], given.rapid[i] != 0);
  ready.finish();

  SlabResult result;
  result.report.strikes = at.strikes;
  SlabTiles tiles = at.tiles;
  const SlabPlace place{
      grid, at.slab, at.fixture, at.probed, context_.tolerance, judged ? &*surface_ : nullptr, std::move(at.part)};
  simulate(place, ready, 0, tiles, result.report, result.stats);
  if (at.fixture < 0) result.tiles = std::move(tiles);
  for (std::size_t k = 0; k < result.tiles.size(); ++k)
    if (result.tiles[k] == at.tiles[k]) result.tiles[k] = nullptr;
  return to_packet(result);
}

}  // namespace riffler::verify
