#include "riffler/sweep/carve.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "riffler/base/check.hpp"
#include "sweep/carve_moves.hpp"
#include "sweep/cut_region.hpp"
#include "sweep/grid_carver.hpp"

namespace riffler::sweep {

namespace {

std::string row(std::size_t i) {
  return "poses, row " + std::to_string(i) + ": ";
}

/// How much a direction's length may differ from 1, and two directions from being square.
constexpr double kSquare = 1e-6;

void check_unit(const Vec3& direction, std::size_t i, const char* name) {
  const double length = glm::length(direction);
  if (!(std::abs(length - 1) < kSquare))
    throw std::invalid_argument(row(i) + "the " + name + " must be a unit vector; its length is " +
                                std::to_string(length));
}

/// Checks that the result, one entry per move, fits in memory. Small results skip the system call.
void check_memory(std::size_t moves) {
  const double bytes = static_cast<double>(moves) * (sizeof(double) + 2 * sizeof(Vec3));
  if (moves < 1'000'000 || bytes <= dexel::available_memory()) return;
  throw std::invalid_argument("poses: the results of " + std::to_string(moves) + " moves need " +
                              std::to_string(static_cast<long long>(bytes / 1e6)) +
                              " MB, more than this machine has free; carve them in several calls");
}

}  // namespace

void check_path(std::span<const Pose> poses) {
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Pose& p = poses[i];
    if (!geom::finite(p.tip) || !geom::finite(p.axis)) throw std::invalid_argument(row(i) + "not finite");
    check_unit(p.axis, i, "axis");
    if (i == 0) continue;
    const Vec3 axis = glm::normalize(p.axis), before = glm::normalize(poses[i - 1].axis);
    if (glm::dot(before, axis) < 0 && glm::length(glm::cross(before, axis)) < 1e-14)
      throw std::invalid_argument(row(i) +
                                  "the axis is exactly opposite to that of the row before, so its rotation is " +
                                  "undefined; put a pose between");
  }
}

void check_path(std::span<const RolledPose> poses) {
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const RolledPose& p = poses[i];
    if (!geom::finite(p.tip) || !geom::finite(p.axis) || !geom::finite(p.forward))
      throw std::invalid_argument(row(i) + "not finite");
    check_unit(p.axis, i, "axis"), check_unit(p.forward, i, "forward direction");
    const double cosine = glm::dot(p.axis, p.forward);
    if (!(std::abs(cosine) < kSquare))
      throw std::invalid_argument(row(i) +
                                  "the forward direction must be square to the axis; the cosine between them " + "is " +
                                  std::to_string(cosine) + ". Subtract its share along the axis");
    if (i > 0 && geom::half_turn(poses[i - 1], p))
      throw std::invalid_argument(row(i) + "the tool is a half turn from the row before, so its rotation is " +
                                  "undefined; put a pose between");
  }
}

void check_options(const CarveOptions& options, std::size_t moves) {
  base::require_tolerance(options.tolerance);
  base::require_between(options.removal_constant, 0, base::kMaxConstant, "removal_constant", "a number",
                        "N·s/mm³, not negative");
  if (!options.dt.empty() && options.dt.size() != moves)
    throw std::invalid_argument("dt must have one value per move: " + std::to_string(moves) + ", not " +
                                std::to_string(options.dt.size()));
  for (std::size_t i = 0; i < options.dt.size(); ++i)
    if (!(options.dt[i] >= base::kMinTime && options.dt[i] <= base::kMaxTime))
      base::require_time(options.dt[i], "dt, row " + std::to_string(i) + ":");
}

namespace {

/// `Body`: what the tool is made of, ConvexGroup or Hull, whose size is given.
template <class Body, class AnyPose>
Cut carve_bodies(Volume& volume, std::span<const Body> cutter, double size, std::span<const AnyPose> poses,
                 const CarveOptions& options) {
  const std::size_t moves = poses.empty() ? 0 : poses.size() - 1;
  check_path(poses);
  check_options(options, moves);
  base::require_tolerance_for(options.tolerance, size);
  check_memory(moves);
  Cut cut{std::vector<double>(moves), std::vector<Vec3>(moves, Vec3(0)), std::vector<Vec3>(moves, Vec3(0))};
  // A plain carve cuts the volume's own tiles and restores them if it fails.
  std::optional<CutRegion> region;
  if (options.mode == CarveMode::Add || options.protect) region = CutRegion::of(volume, options.mode, options.protect);
  Rollback rollback;
  dexel::Stats stats;
  stats.moves = moves;
  const std::size_t grids = volume.grids().size();
  for (std::size_t g = 0; g < grids; ++g) {
    dexel::Grid& grid = volume.grids()[g];
    const bool measured = &grid == &volume.reference();
    GridCarver carver = region ? GridCarver(region->grid(g), measured, options, cut)
                               : GridCarver(grid, measured, options, cut, &rollback);
    const auto next = [](std::size_t m) { return m + 1; };
    carver.run(cutter, poses, moves, next, [&](std::size_t done) {
      base::report(options.progress, (static_cast<double>(g) + static_cast<double>(done) / static_cast<double>(moves)) /
                                         static_cast<double>(grids));
    });
    base::report(options.progress, static_cast<double>(g + 1) / static_cast<double>(grids));
    stats += carver.take_stats();
  }
  if (region ? region->commit(volume) : rollback.commit()) volume.touch();
  volume.count(stats);
  return cut;
}

[[noreturn]] void refuse_plain(const Tool& tool) {
  throw std::invalid_argument("poses: the hand tool \"" + tool.name() +
                              "\" needs nine numbers in each row: tip, axis, and the forward direction");
}

[[noreturn]] void refuse_rolled(const Tool& tool) {
  throw std::invalid_argument(
      "poses: the tool \"" + tool.name() +
      "\" is a body of revolution and has no forward direction; give it six numbers in each row: tip and axis");
}

double size_of(const Tool& tool) {
  return std::max(tool.length(), tool.diameter());
}

}  // namespace

void check_poses_suit(const Tool& tool, std::size_t plain, std::size_t rolled) {
  if (!tool.revolved() && plain > 0) refuse_plain(tool);
  if (tool.revolved() && rolled > 0) refuse_rolled(tool);
}

Cut carve(Volume& volume, const Tool& tool, std::span<const Pose> poses, const CarveOptions& options) {
  if (!tool.revolved()) refuse_plain(tool);
  const std::vector<ConvexGroup> cutter = convex_groups(tool.cutter());
  return carve_bodies(volume, std::span<const ConvexGroup>(cutter), size_of(tool), poses, options);
}

Cut carve(Volume& volume, const Tool& tool, std::span<const RolledPose> poses, const CarveOptions& options) {
  if (tool.revolved()) refuse_rolled(tool);
  return carve_bodies(volume, std::span<const tool::Hull>(tool.hulls()), size_of(tool), poses, options);
}

std::vector<double> carve_moves(dexel::Grid& grid, std::span<const ConvexGroup> cutter, std::span<const Pose> poses,
                                std::span<const std::uint32_t> ends, double tolerance, dexel::Stats& stats) {
  CarveOptions options;
  options.tolerance = tolerance;
  Cut cut{std::vector<double>(ends.size()), std::vector<Vec3>(ends.size()), std::vector<Vec3>(ends.size())};
  GridCarver carver(grid, true, options, cut, nullptr);
  carver.run(cutter, poses, ends.size(), [&](std::size_t m) { return ends[m]; }, [](std::size_t) {});
  stats += carver.take_stats();
  stats.moves += ends.size();
  return std::move(cut.removed);
}

}  // namespace riffler::sweep
