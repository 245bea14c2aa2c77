#include "verify/timing.hpp"

#include "geom/directions.hpp"

namespace riffler {

double seconds_of(const Pose& from, const Program& program, std::size_t row, double rapid_feed) {
  constexpr double degrees = 57.29577951308232;
  const Pose& to = program.poses()[row];
  const double way = glm::length(to.tip - from.tip);
  if (way == 0) {
    const double angle = angle_between(from.axis, to.axis);
    return 60 * angle * degrees / kRotaryRate;
  }
  return 60 * way / (program.rapid()[row] ? rapid_feed : program.feed()[row]);
}

}  // namespace riffler
