#include "haptics/passive_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "haptics/settings.hpp"

namespace riffler {

PassiveStiffness passive_stiffness(const DeviceTraits& device, double wall_damping) {
  require_positive("period", device.period);
  require_not_negative("damping", device.damping);
  require_not_negative("friction", device.friction);
  require_not_negative("resolution", device.resolution);
  if (!std::isfinite(wall_damping)) throw std::invalid_argument("wall_damping must be finite");
  return {2 * std::max(0.0, device.damping - std::abs(wall_damping)) / device.period,
          device.resolution > 0 ? 2 * device.friction / device.resolution : std::numeric_limits<double>::infinity()};
}

}  // namespace riffler
