#include "riffler/sweep/move_carver.hpp"

#include <array>
#include <vector>

#include "riffler/base/block_pool.hpp"
#include "riffler/base/check.hpp"
#include "riffler/sweep/carve.hpp"
#include "sweep/grid_carver.hpp"

namespace riffler::sweep {

struct MoveCarver::Core {
  Core(Volume& volume, const Tool& tool, const Options& options);
  Taken move(const Pose& from, const Pose& to, double dt);

  Volume& volume_;
  std::vector<ConvexGroup> cutter_;
  CarveOptions options_;
  Cut cut_;
  Rollback rollback_;
  base::BlockVector<Place> replaced_;
  std::vector<GridCarver> carvers_;
};

MoveCarver::Core::Core(Volume& volume, const Tool& tool, const Options& options)
    : volume_(volume), cutter_(convex_groups(tool.cutter())), cut_{{0}, {Vec3(0)}, {Vec3(0)}} {
  options_.tolerance = options.tolerance, options_.removal_constant = options.removal_constant;
  options_.dt = {1};
  check_options(options_, 1);
  base::require_tolerance_for(options_.tolerance, std::max(tool.length(), tool.diameter()));
  carvers_.reserve(volume.grids().size());
  for (dexel::Grid& grid : volume.grids())
    carvers_.emplace_back(grid, &grid == &volume.reference(), options_, cut_, &rollback_);
}

MoveCarver::Taken MoveCarver::Core::move(const Pose& from, const Pose& to, double dt) {
  const std::array<Pose, 2> poses{from, to};
  check_path(poses);
  options_.dt[0] = dt;
  check_options(options_, 1);
  cut_.removed[0] = 0, cut_.force[0] = cut_.torque[0] = Vec3(0);
  dexel::Stats stats;
  stats.moves = 1;
  replaced_.clear();
  try {
    for (GridCarver& carver : carvers_) {
      carver.run(cutter_, poses, 1, [](std::size_t) { return std::size_t{1}; }, [](std::size_t) {});
      stats += carver.take_stats();
    }
  } catch (...) {
    rollback_.undo();
    throw;
  }
  const dexel::Grid* const first = volume_.grids().data();
  rollback_.each([&](const dexel::Grid& grid, std::size_t tile) {
    replaced_.push_back({static_cast<std::uint32_t>(&grid - first), static_cast<std::uint32_t>(tile)});
  });
  if (rollback_.commit()) volume_.touch();
  volume_.count(stats);
  return {cut_.removed[0], cut_.force[0], cut_.torque[0]};
}

MoveCarver::MoveCarver(Volume& volume, const Tool& tool, const Options& options)
    : core_(std::make_unique<Core>(volume, tool, options)) {}

MoveCarver::~MoveCarver() = default;

MoveCarver::Taken MoveCarver::move(const Pose& from, const Pose& to, double dt) {
  return core_->move(from, to, dt);
}

double MoveCarver::pitch() const {
  return core_->volume_.reference().pitch();
}

std::span<const MoveCarver::Place> MoveCarver::replaced() const {
  return core_->replaced_;
}

}  // namespace riffler::sweep
