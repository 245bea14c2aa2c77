#include "verify/task.hpp"

namespace riffler {

SlabResult simulate(const SlabTask& task) {
  std::vector<ToolShapes> shapes;
  for (const Tool& tool : task.tools) shapes.emplace_back(tool, task.tolerance, task.beyond, task.pitch);
  Moves moves(task.poses, 2, shapes, task.top);
  for (std::size_t k = 0; k < task.rows.size(); ++k) moves.add(task.rows[k], task.tool[k], task.rapid[k] != 0);
  moves.finish();
  SlabResult result{task.job, task.material, {}, {}};
  const Slab slab = slabs_of(task.material).at(task.slab);
  const Grid& grid = task.material.grids()[slab.grid];
  if (task.fixture >= 0) {
    simulate_fixture(grid, slab, task.fixture, task.tolerance, moves, 0, result.report, result.stats);
    return result;
  }
  std::optional<Target> target;
  if (task.part) target.emplace(*task.part, *task.target, task.gouge_tolerance);
  SlabTiles state = tiles_of(grid, slab);
  const bool probed = &grid == &task.material.reference();
  SlabSimulation(grid, slab, probed, task.tolerance, target ? &*target : nullptr)
      .run(moves, 0, state, result.report, result.stats);
  put_tiles(result.material.grids()[slab.grid], slab, state);
  result.material.touch();
  return result;
}

}  // namespace riffler
