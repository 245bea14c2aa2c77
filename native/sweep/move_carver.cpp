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
  void move_one(GridCarver& carver, std::span<const Pose> poses);
  void publish();
  bool publish_part();

  Volume& volume_;
  std::vector<ConvexGroup> cutter_;
  CarveOptions options_;
  Cut cut_;
  Rollback rollback_;
  base::BlockVector<Place> replaced_;
  bool deferred_ = false;
  std::deque<GridCarver> carvers_;  // the reference's first; a deque: they cannot move
  bool asked_ = false, publishing_ = false;
  int idle_ = 0;  // moves since the reference grid was cut
};

MoveCarver::Core::Core(Volume& volume, const Tool& tool, const Options& options)
    : volume_(volume), cutter_(convex_groups(tool.cutter())), cut_{{0}, {Vec3(0)}, {Vec3(0)}} {
  options_.tolerance = options.tolerance, options_.removal_constant = options.removal_constant;
  options_.dt = {1};
  check_options(options_, 1);
  base::require_tolerance_for(options_.tolerance, std::max(tool.length(), tool.diameter()));
  deferred_ = options.deferred;
  for (const bool reference : {true, false})
    for (dexel::Grid& grid : volume.grids()) {
      if ((&grid == &volume.reference()) != reference) continue;
      carvers_.emplace_back(grid, reference, options_, cut_, &rollback_);
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
  asked_ = publishing_ = false;
}

MoveCarver::Taken MoveCarver::Core::move(const Pose& from, const Pose& to, double dt) {
  const std::array<Pose, 2> poses{from, to};
  check_path(poses);
  options_.dt[0] = dt;
  check_options(options_, 1);
  cut_.removed[0] = 0, cut_.force[0] = cut_.torque[0] = Vec3(0);
  const bool full =
      deferred_ && std::any_of(carvers_.begin(), carvers_.end(), [](const GridCarver& c) { return c.full(); });
  each_grid(1, [&](GridCarver& carver) {
    if (full) carver.pack();
    if (full && &carver == &carvers_.back()) asked_ = publishing_ = false;
    move_one(carver, poses);
  });
  return {cut_.removed[0], cut_.force[0], cut_.torque[0]};
}

/// Force and removal come from the reference grid. The others follow it a few moves later, so that several steps find
/// their tiles in the cache, and each move takes about as long as the others. As long as nothing is cut, they keep up:
/// cut_something counts them.
void MoveCarver::Core::move_one(GridCarver& carver, std::span<const Pose> poses) {
  const GridCarver& reference = carvers_.front();
  constexpr int kIdle = 16;  // moves
  const bool follows = deferred_ && &carver != &reference;
  carver.put_off(follows && (idle_ == 0 || (idle_ < kIdle && carver.behind())));
  carver.run(
      std::span<const ConvexGroup>(cutter_), poses, 1, [](std::size_t) { return std::size_t{1}; }, [](std::size_t) {});
  if (!follows) idle_ = reference.cut_something() ? 0 : std::min(idle_ + 1, kIdle);
  if (!deferred_) return carver.pack();
  if (asked_) return;
  if (follows)
    carver.advance();
  else
    carver.pack_left();
}

void MoveCarver::Core::publish() {
  each_grid(0, [](GridCarver& carver) { carver.pack(); });
  asked_ = publishing_ = false;
}

bool MoveCarver::Core::publish_part() {
  if (!std::exchange(asked_, true) && carvers_.size() > 1) {
    replaced_.clear();
    return false;  // the next move leaves its time to packing
  }
  const bool begins = !publishing_;
  each_grid(0, [&](GridCarver& carver) {
    if (!begins) {
      if (carver.publishing()) carver.advance();
    } else if (&carver == &carvers_.front()) {
      carver.pack();
    } else {
      carver.begin_publish();
    }
  });
  publishing_ = std::any_of(carvers_.begin(), carvers_.end(), [](const GridCarver& c) { return c.publishing(); });
  asked_ = publishing_;
  return !publishing_;
}

MoveCarver::MoveCarver(Volume& volume, const Tool& tool, const Options& options)
    : core_(std::make_unique<Core>(volume, tool, options)) {}

MoveCarver::~MoveCarver() = default;

MoveCarver::Taken MoveCarver::move(const Pose& from, const Pose& to, double dt) {
  return core_->move(from, to, dt);
}

bool MoveCarver::cut_something() const {
  return std::any_of(core_->carvers_.begin(), core_->carvers_.end(),
                     [](const GridCarver& carver) { return carver.cut_something() || carver.behind(); });
}

void MoveCarver::publish() {
  core_->publish();
}

bool MoveCarver::publish_part() {
  return core_->publish_part();
}

bool MoveCarver::publishing() const {
  return core_->publishing_;
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
