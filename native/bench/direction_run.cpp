#include "bench/direction_run.hpp"

#include "base/own_thread.hpp"
#include "riffler/base/block_pool.hpp"
#include "riffler/sweep/move_carver.hpp"
#include "riffler/tool/cutters.hpp"

namespace riffler::bench {

DirectionRun direction_run(const DirectionOptions& o) {
  Volume volume = Volume::block({{{0, 0, -15}, {80, 80, 0}}, o.pitch, o.directions});
  sweep::MoveCarver carver(volume, cutters::ball(20, 60), {.deferred = o.shown > 0});
  base::BlockReserve reserve;  // as in a session
  DirectionRun out;
  bool asked = false;
  for (std::size_t k = 0; k + 1 < o.poses.size(); ++k) {
    if (k % 33 == 0) reserve.fill(1 << 15, 128);
    const double start = base::thread_seconds();
    out.removed += carver.move(o.poses[k], o.poses[k + 1], 1e-3).removed;
    asked = asked || (o.shown > 0 && (k + 1) % static_cast<std::size_t>(o.shown) == 0);
    if (asked) asked = !carver.publish_part();
    out.seconds.push_back(base::thread_seconds() - start);
  }
  carver.publish();  // completes the counts
  const dexel::Stats stats = volume.take_stats();
  out.tested = stats.rays_tested, out.changed = stats.rays_changed;
  return out;
}

}  // namespace riffler::bench
