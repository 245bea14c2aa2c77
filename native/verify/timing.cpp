#include "verify/timing.hpp"

#include <stdexcept>
#include <string>

#include "geom/directions.hpp"
#include "geom/math.hpp"
#include "nc/limits.hpp"

namespace riffler::verify {

double seconds_of(const Pose& from, const nc::Program& program, std::size_t row, double rapid_feed) {
  constexpr double degrees = kRadian;
  const Pose& to = program.poses()[row];
  const double way = glm::length(to.tip - from.tip);
  if (way == 0) {
    const double angle = geom::angle_between(from.axis, to.axis);
    return 60 * angle * degrees / kRotaryRate;
  }
  const double minutes = way / (program.rapid()[row] ? rapid_feed : program.feed()[row]);
  if (!(minutes <= nc::kMaxMinutes))
    throw std::invalid_argument("program, row " + std::to_string(row) +
                                ": its feed is so small that the move takes more than a thousand years");
  return 60 * minutes;
}

}  // namespace riffler::verify
