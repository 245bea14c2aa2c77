#include "bench/direction_run.hpp"

#include <cmath>
#include <numbers>

#include "base/own_thread.hpp"
#include "riffler/base/block_pool.hpp"
#include "riffler/sweep/move_carver.hpp"
#include "riffler/tool/cutters.hpp"

namespace riffler::bench {

namespace {

std::vector<Pose> spiral(int steps, bool turning) {
  constexpr double kStep = 0.5, kRadius = 20, kTurn = 4, kMiddle = 40, kBall = 10;  // mm
  constexpr double kSwing = 15 * std::numbers::pi / 180;
  std::vector<Pose> poses;
  double angle = 0;
  for (int k = 0; k <= steps; ++k) {
    const double radius = kRadius - kTurn * angle / (2 * std::numbers::pi);
    const double swing = turning ? kSwing * std::sin(k / 40.0) : 0;
    const Vec3 axis(std::sin(swing), 0, std::cos(swing));
    poses.push_back(
        {Vec3(kMiddle + radius * std::cos(angle), kMiddle + radius * std::sin(angle), 0) - kBall * axis, axis});
    angle += kStep / radius;
  }
  return poses;
}

}  // namespace

DirectionRun direction_run(const DirectionOptions& o) {
  Volume volume = Volume::block({{{0, 0, -15}, {80, 80, 0}}, o.pitch, o.directions});
  const std::vector<Pose> poses = spiral(o.steps, o.turning);
  sweep::MoveCarver carver(volume, cutters::ball(20, 60), {.deferred = o.shown > 0});
  base::BlockReserve reserve;  // as a session has it
  DirectionRun out;
  for (int k = 0; k < o.steps; ++k) {
    if (k % 33 == 0) reserve.fill(1 << 15, 128);
    const double start = base::thread_seconds();
    out.removed += carver.move(poses[k], poses[k + 1], 1e-3).removed;
    if (o.shown > 0 && (k + 1) % o.shown == 0) carver.publish();
    out.seconds.push_back(base::thread_seconds() - start);
  }
  const dexel::Stats stats = volume.take_stats();
  out.tested = stats.rays_tested, out.changed = stats.rays_changed;
  return out;
}

}  // namespace riffler::bench
