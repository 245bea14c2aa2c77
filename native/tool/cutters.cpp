#include "tool/cutters.hpp"

#include <cmath>
#include <stdexcept>

#include "base/check.hpp"

namespace riffler::cutters {

namespace {

void need_angle(double x, const char* name) {
  if (!std::isfinite(x) || !(x > 0) || !(x < std::acos(-1.0) / 2))
    throw std::invalid_argument(std::string(name) + " must lie between 0 and pi/2 rad");
}

/// Height is where the last cone or arc ends; the cylinder above it needs the rest of `length`.
void need_length(double length, double height) {
  if (length < height)
    throw std::invalid_argument("length " + std::to_string(length) + " mm ends below the cutter's shaped end (" +
                                std::to_string(height) + " mm)");
}

ProfileSegment line(double r, double z) {
  return {{r, z}, {}};
}
ProfileSegment arc(double r, double z, double cr, double cz) {
  return {{r, z}, Vec2{cr, cz}};
}

/// `segments`, then the cylinder up to `length`.
Profile up_to(std::vector<ProfileSegment> segments, double length) {
  const Vec2 end = segments.back().to;
  need_length(length, end.y);
  if (length > end.y) segments.push_back(line(end.x, length));
  return Profile(std::move(segments));
}

}  // namespace

Tool ball(double diameter, double length) {
  require_length(diameter, "diameter");
  require_length(length, "length");
  const double r = diameter / 2;
  return {"ball", {{"diameter", diameter}, {"length", length}}, up_to({arc(r, r, 0, r)}, length)};
}

Tool flat(double diameter, double length) {
  require_length(diameter, "diameter");
  require_length(length, "length");
  return {"flat", {{"diameter", diameter}, {"length", length}}, up_to({line(diameter / 2, 0)}, length)};
}

Tool fillet(double diameter, double corner_radius, double length) {
  require_length(diameter, "diameter");
  require_length(corner_radius, "corner_radius");
  require_length(length, "length");
  const double e = diameter / 2 - corner_radius;
  if (e < 0) throw std::invalid_argument("corner_radius must not exceed half the diameter");
  std::vector<ProfileSegment> segments;
  if (e > 0) segments.push_back(line(e, 0));
  segments.push_back(arc(diameter / 2, corner_radius, e, corner_radius));
  return {"fillet",
          {{"diameter", diameter}, {"corner_radius", corner_radius}, {"length", length}},
          up_to(std::move(segments), length)};
}

Tool taper(double tip_radius, double half_angle, double diameter, double length, bool flat_tip) {
  require_not_negative(tip_radius, "tip_radius");
  need_angle(half_angle, "half_angle");
  require_length(diameter, "diameter");
  require_length(length, "length");
  const double r = diameter / 2, t = tip_radius;
  const Vec2 start = flat_tip ? Vec2(t, 0) : t * Vec2(std::cos(half_angle), 1 - std::sin(half_angle));
  if (start.x > r) throw std::invalid_argument("tip_radius is too large for the diameter");
  std::vector<ProfileSegment> segments;
  if (t > 0) segments.push_back(flat_tip ? line(t, 0) : arc(start.x, start.y, 0, t));
  if (r > start.x) segments.push_back(line(r, start.y + (r - start.x) / std::tan(half_angle)));
  return {"taper",
          {{"tip_radius", tip_radius},
           {"half_angle", half_angle},
           {"diameter", diameter},
           {"length", length},
           {"flat_tip", flat_tip ? 1.0 : 0.0}},
          up_to(std::move(segments), length)};
}

Tool cone_end(double tip_half_angle, double tip_height, double half_angle, double diameter, double length) {
  need_angle(tip_half_angle, "tip_half_angle");
  require_length(tip_height, "tip_height");
  need_angle(half_angle, "half_angle");
  require_length(diameter, "diameter");
  require_length(length, "length");
  const double r = diameter / 2, shoulder = tip_height * std::tan(tip_half_angle);
  if (shoulder > r) throw std::invalid_argument("tip_height: the first cone is wider there than the diameter");
  std::vector<ProfileSegment> segments{line(shoulder, tip_height)};
  if (r > shoulder) segments.push_back(line(r, tip_height + (r - shoulder) / std::tan(half_angle)));
  return {"cone_end",
          {{"tip_half_angle", tip_half_angle},
           {"tip_height", tip_height},
           {"half_angle", half_angle},
           {"diameter", diameter},
           {"length", length}},
          up_to(std::move(segments), length)};
}

Tool profile(std::vector<ProfileSegment> segments, double length) {
  require_length(length, "length");
  if (segments.empty()) throw std::invalid_argument("segments must not be empty");
  return {"profile", {{"length", length}}, up_to(std::move(segments), length)};
}

}  // namespace riffler::cutters
