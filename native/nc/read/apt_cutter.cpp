#include "nc/read/apt_cutter.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include "geom/math.hpp"
#include "tool/cutters.hpp"

namespace riffler {

std::optional<Tool> apt_cutter(std::vector<double> v, double unit, const NcPlace& place) {
  const bool has_height = v.size() == 7;
  v.resize(7);
  const double d = v[0] * unit, r = v[1] * unit, h = v[6] * unit, flank = v[5] * kDegree;
  // The corner's centre lies where a corner that touches the end and the flank has it.
  const double slack = 1e-6 * std::abs(d);
  const bool plain = std::abs(v[2] * unit - (d / 2 - r)) <= slack && std::abs(v[3] * unit - r) <= slack && v[4] == 0;
  const bool is_ball = std::abs(2 * r - d) <= slack;
  if (!(has_height && plain && d > 0 && r >= 0 && h > 0 && flank >= 0) || (flank > 0 && !is_ball)) return std::nullopt;
  try {
    if (flank > 0)  // a cone up to the top, from where the ball ends
      return cutters::taper(r, flank, 2 * (r * std::cos(flank) + (h - r * (1 - std::sin(flank))) * std::tan(flank)), h);
    if (r == 0) return cutters::flat(d, h);
    if (is_ball) return cutters::ball(d, h);
    return cutters::fillet(d, r, h);
  } catch (const std::invalid_argument& e) {
    place.fail(std::string("CUTTER: ") + e.what());
  }
}

}  // namespace riffler
