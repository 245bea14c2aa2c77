#include "stress/passive_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "riffler/haptics/settings.hpp"

namespace riffler {

PassiveStiffness passive_stiffness(const DeviceTraits& device, double wall_damping) {
  require_positive(device.period, "period");
  require_not_negative(device.damping, "damping");
  require_not_negative(device.friction, "friction");
  require_not_negative(device.resolution, "resolution");
  require(std::isfinite(wall_damping), "wall_damping", "must be finite");
  return {2 * std::max(0.0, device.damping - std::abs(wall_damping)) / device.period,
          device.resolution > 0 ? 2 * device.friction / device.resolution : std::numeric_limits<double>::infinity()};
}

}  // namespace riffler
