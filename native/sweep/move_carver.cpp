#include "riffler/sweep/move_carver.hpp"

#include <algorithm>
#include <array>
#include <deque>
#include <vector>

#include "riffler/base/block_pool.hpp"
#include "riffler/base/check.hpp"
#include "riffler/sweep/carve.hpp"
#include "sweep/grid_carver.hpp"

namespace riffler::sweep {

struct MoveCarver::Core {
  Core(Volume& volume, const Tool& tool, const Options& options);
  Taken move(const Pose& from, const Pose& to, double dt);
  /// Runs body(carver) for each grid. Unless deferred, the volume changes as a whole or, if `body` throws, not at all.
  template <class Body>
  void each_grid(std::uint64_t moves, const Body& body);
  void settle();
  void undo() noexcept;

  Volume& volume_;
  std::vector<ConvexGroup> cutter_;
  CarveOptions options_;
  Cut cut_;
  Rollback rollback_;
  base::BlockVector<Place> replaced_;
  bool deferred_ = false;
  std::deque<GridCarver> carvers_;  // a deque: they cannot move
};

MoveCarver::Core::Core(Volume& volume, const Tool& tool, const Options& options)
    : volume_(volume), cutter_(convex_groups(tool.cutter())), cut_{{0}, {Vec3(0)}, {Vec3(0)}} {
  options_.tolerance = options.tolerance, options_.removal_constant = options.removal_constant;
  options_.dt = {1};
  check_options(options_, 1);
  base::require_tolerance_for(options_.tolerance, std::max(tool.length(), tool.diameter()));
  deferred_ = options.deferred;
  for (dexel::Grid& grid : volume.grids()) {
    carvers_.emplace_back(grid, &grid == &volume.reference(), options_, cut_, &rollback_);
    carvers_.back().keep_open(std::max(tool.length(), tool.diameter()));
  }
}

template <class Body>
void MoveCarver::Core::each_grid(std::uint64_t moves, const Body& body) {
  replaced_.clear();
  dexel::Stats stats;
  stats.moves = moves;
  try {
    for (GridCarver& carver : carvers_) {
      body(carver);
      stats += carver.take_stats();
    }
  } catch (...) {
    if (deferred_)
      settle();
    else
      undo();
    throw;
  }
  settle();
  volume_.count(stats);
}

void MoveCarver::Core::settle() {
  const dexel::Grid* const first = volume_.grids().data();
  rollback_.each([&](const dexel::Grid& grid, std::size_t tile) {
    replaced_.push_back({static_cast<std::uint32_t>(&grid - first), static_cast<std::uint32_t>(tile)});
  });
  if (rollback_.commit()) volume_.touch();
}

void MoveCarver::Core::undo() noexcept {
  rollback_.undo();
  for (GridCarver& carver : carvers_) carver.forget();
}

MoveCarver::Taken MoveCarver::Core::move(const Pose& from, const Pose& to, double dt) {
  const std::array<Pose, 2> poses{from, to};
  check_path(poses);
  options_.dt[0] = dt;
  check_options(options_, 1);
  cut_.removed[0] = 0, cut_.force[0] = cut_.torque[0] = Vec3(0);
  each_grid(1, [&](GridCarver& carver) {
    carver.run(cutter_, poses, 1, [](std::size_t) { return std::size_t{1}; }, [](std::size_t) {});
    if (deferred_)
      carver.pack_left();
    else
      carver.pack();
  });
  return {cut_.removed[0], cut_.force[0], cut_.torque[0]};
}

MoveCarver::MoveCarver(Volume& volume, const Tool& tool, const Options& options)
    : core_(std::make_unique<Core>(volume, tool, options)) {}

MoveCarver::~MoveCarver() = default;

MoveCarver::Taken MoveCarver::move(const Pose& from, const Pose& to, double dt) {
  return core_->move(from, to, dt);
}

bool MoveCarver::cut_something() const {
  return std::any_of(core_->carvers_.begin(), core_->carvers_.end(),
                     [](const GridCarver& carver) { return carver.cut_something(); });
}

void MoveCarver::publish() {
  core_->each_grid(0, [](GridCarver& carver) { carver.pack(); });
}

void MoveCarver::forget() noexcept {
  core_->undo();
}

double MoveCarver::pitch() const {
  return core_->volume_.reference().pitch();
}

std::span<const MoveCarver::Place> MoveCarver::replaced() const {
  return core_->replaced_;
}

}  // namespace riffler::sweep
