#include "stress/passive_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "riffler/haptics/settings.hpp"

namespace riffler::haptics {

PassiveStiffness passive_stiffness(const DeviceTraits& device, double wall_damping) {
  base::require_positive(device.period, "period");
  base::require_not_negative(device.damping, "damping");
  base::require_not_negative(device.friction, "friction");
  base::require_not_negative(device.resolution, "resolution");
  base::require(std::isfinite(wall_damping), "wall_damping", "must be finite");
  return {2 * std::max(0.0, device.damping - std::abs(wall_damping)) / device.period,
          device.resolution > 0 ? 2 * device.friction / device.resolution : std::numeric_limits<double>::infinity()};
}

}  // namespace riffler::haptics
