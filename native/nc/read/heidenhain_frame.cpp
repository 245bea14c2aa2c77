#include "nc/read/heidenhain_frame.hpp"

#include <cmath>

#include "base/functions.hpp"
#include "geom/math.hpp"
#include "nc/read/frame.hpp"

namespace riffler::nc {

namespace {

Vec3 rotated(const Vec3& v, double degrees) {
  const Vec2 xy = turned_in_plane({v.x, v.y}, degrees);
  return {xy.x, xy.y, v.z};
}

/// Exact for multiples of a right angle, as most planes have.
void sine_and_cosine(double degrees, double& sine, double& cosine) {
  const double quarters = degrees / 90;
  if (quarters == std::round(quarters)) {
    constexpr double kSines[] = {0, 1, 0, -1};
    const int k = static_cast<int>(std::fmod(quarters, 4) + 4) % 4;
    sine = kSines[k], cosine = kSines[(k + 1) % 4];
    return;
  }
  const double angle = degrees * kDegree;
  sine = base::sin(angle), cosine = base::cos(angle);
}

}  // namespace

Vec3 HeidenhainFrame::direction_to_part(const Vec3& v) const {
  return turn * rotated(v, rotation);
}

Vec3 HeidenhainFrame::to_part(const Vec3& p) const {
  const Vec3 in_plane = rotated(p, rotation) + plane_shift;
  return (tilted ? turn * in_plane : in_plane) + shift;
}

Vec3 HeidenhainFrame::from_part(const Vec3& p) const {
  const Vec3 from_origin = p - shift;
  const Vec3 in_plane = tilted ? glm::transpose(turn) * from_origin : from_origin;
  return rotated(in_plane - plane_shift, -rotation);
}

Mat3 spatial_turn(const Vec3& angles) {
  double sa, ca, sb, cb, sc, cc;
  sine_and_cosine(angles.x, sa, ca);
  sine_and_cosine(angles.y, sb, cb);
  sine_and_cosine(angles.z, sc, cc);
  // Columns: the directions of the plane's axes.
  const Mat3 about_x(Vec3(1, 0, 0), Vec3(0, ca, sa), Vec3(0, -sa, ca));
  const Mat3 about_y(Vec3(cb, 0, -sb), Vec3(0, 1, 0), Vec3(sb, 0, cb));
  const Mat3 about_z(Vec3(cc, sc, 0), Vec3(-sc, cc, 0), Vec3(0, 0, 1));
  return about_z * about_y * about_x;
}

}  // namespace riffler::nc
