#include "nc/read/frame.hpp"

#include "base/functions.hpp"
#include "geom/math.hpp"

namespace riffler::nc {

Vec2 turned_in_plane(const Vec2& v, double degrees) {
  if (degrees == 0) return v;
  const double angle = degrees * kDegree, c = base::cos(angle), s = base::sin(angle);
  return {c * v.x - s * v.y, s * v.x + c * v.y};
}

Joints NcFrame::to_machine(const Joints& program) const {
  Joints out;
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = program[k] + shift[k];
  const Vec2 xy = turned_in_plane({out[0], out[1]}, rotation);
  out[0] = xy.x + tip.x, out[1] = xy.y + tip.y, out[2] += tip.z;
  for (std::size_t k = 0; k < out.size(); ++k) out[k] += origin[k];
  return out;
}

Joints NcFrame::to_program(const Joints& machine) const {
  Joints out;
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = machine[k] - origin[k];
  const Vec2 xy = turned_in_plane({out[0] - tip.x, out[1] - tip.y}, -rotation);
  out[0] = xy.x, out[1] = xy.y, out[2] -= tip.z;
  for (std::size_t k = 0; k < out.size(); ++k) out[k] -= shift[k];
  return out;
}

}  // namespace riffler::nc
