#include "riffler/tool/cutters.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>

#include "base/functions.hpp"
#include "geom/math.hpp"
#include "riffler/base/check.hpp"

namespace riffler::tool {

namespace {

// Sizes. The ranges are those of the form fields; a cutter may have any size that gives a valid profile.

constexpr double kLow = 1e-3, kHigh = 1e5;                                // mm
constexpr double kLowAngle = 0.1 * kDegree, kHighAngle = 89.9 * kDegree;  // rad

constexpr CutterSize kDiameter{
    "diameter", SizeUnit::Length, "Diameter", "Diameter of the cylinder above the end, in mm", kLow, kHigh, 6};
constexpr CutterSize kLength{"length", SizeUnit::Length, "Length", "Cutting length from the tip, in mm", kLow, kHigh,
                             30};
constexpr CutterSize kCornerRadius{
    "corner_radius", SizeUnit::Length, "Corner Radius", "Radius of the rounded edge, in mm", kLow, kHigh, 1, 0.5};
constexpr CutterSize kTipRadius{
    "tip_radius", SizeUnit::Length, "Tip Radius", "Radius of the ball or flat at the tip, in mm", 1e-4, kHigh, 0.5, 0,
    true};
constexpr CutterSize kTipHeight{
    "tip_height", SizeUnit::Length, "Tip Height", "Height of the first cone, in mm", kLow, kHigh, 1};
constexpr CutterSize kHalfAngle{"half_angle", SizeUnit::Angle, "Half Angle", "Angle between the axis and the flank",
                                kLowAngle,    kHighAngle,      5 * kDegree};
constexpr CutterSize kTipHalfAngle{
    "tip_half_angle", SizeUnit::Angle, "Tip Half Angle", "Angle between the axis and the first cone",
    kLowAngle,        kHighAngle,      30 * kDegree};
constexpr CutterSize kFlatTip{"flat_tip", SizeUnit::Flag, "Flat Tip", "A flat instead of a ball at the tip", 0, 1, 0};

void check(const CutterSize& size, double x) {
  if (size.unit == SizeUnit::Angle) base::require(x > 0 && x < kPi / 2, size.name, "must lie between 0 and pi/2 rad");
  if (size.unit == SizeUnit::Length && size.may_be_zero) base::require_not_negative(x, size.name);
  if (size.unit == SizeUnit::Length && !size.may_be_zero) base::require_length(x, size.name);
}

// Profiles and CUTTER statements of each shape.

ProfileSegment line(double r, double z) {
  return {{r, z}, {}};
}
ProfileSegment arc(double r, double z, double cr, double cz) {
  return {{r, z}, Vec2{cr, cz}};
}

/// `segments`, then a cylinder up to `length`.
Profile up_to(std::vector<ProfileSegment> segments, double length) {
  const Vec2 end = segments.back().to;
  if (length < end.y)
    throw std::invalid_argument("length " + std::to_string(length) + " mm ends below the cutter's shaped end (" +
                                std::to_string(end.y) + " mm)");
  if (length > end.y) segments.push_back(line(end.x, length));
  return Profile(std::move(segments));
}

using Sizes = std::optional<std::vector<double>>;

/// Numbers in APT files are rounded.
bool nearly(double x, double y, const AptCutter& apt) {
  return std::abs(x - y) <= 1e-6 * std::abs(apt.d);
}

/// Whether the end is flat, and the corner is tangent to both the end and a flank that does not narrow upwards.
bool has_plain_corner(const AptCutter& apt) {
  return nearly(apt.e, apt.d / 2 - apt.r, apt) && nearly(apt.f, apt.r, apt) && apt.a == 0 && apt.d > 0 && apt.r >= 0 &&
         apt.h > 0 && apt.b >= 0;
}

bool has_ball(const AptCutter& apt) {
  return nearly(2 * apt.r, apt.d, apt);
}

Profile ball_profile(double diameter, double length) {
  const double r = diameter / 2;
  return up_to({arc(r, r, 0, r)}, length);
}
AptCutter ball_to_apt(double diameter, double length) {
  return {diameter, diameter / 2, 0, diameter / 2, 0, 0, length};
}
Sizes ball_from_apt(const AptCutter& apt) {
  return has_plain_corner(apt) && has_ball(apt) && apt.b == 0 ? Sizes({apt.d, apt.h}) : std::nullopt;
}

Profile flat_profile(double diameter, double length) {
  return up_to({line(diameter / 2, 0)}, length);
}
AptCutter flat_to_apt(double diameter, double length) {
  return {diameter, 0, diameter / 2, 0, 0, 0, length};
}
Sizes flat_from_apt(const AptCutter& apt) {
  return has_plain_corner(apt) && apt.r == 0 && apt.b == 0 ? Sizes({apt.d, apt.h}) : std::nullopt;
}

Profile fillet_profile(double diameter, double corner_radius, double length) {
  const double e = diameter / 2 - corner_radius;
  if (e < 0) throw std::invalid_argument("corner_radius must not exceed half the diameter");
  std::vector<ProfileSegment> segments;
  if (e > 0) segments.push_back(line(e, 0));
  segments.push_back(arc(diameter / 2, corner_radius, e, corner_radius));
  return up_to(std::move(segments), length);
}
AptCutter fillet_to_apt(double diameter, double corner_radius, double length) {
  return {diameter, corner_radius, diameter / 2 - corner_radius, corner_radius, 0, 0, length};
}
Sizes fillet_from_apt(const AptCutter& apt) {
  const bool fits = has_plain_corner(apt) && !has_ball(apt) && apt.r > 0 && apt.b == 0;
  return fits ? Sizes({apt.d, apt.r, apt.h}) : std::nullopt;
}

Profile taper_profile(double tip_radius, double half_angle, double diameter, double length, bool flat_tip) {
  const double r = diameter / 2, t = tip_radius;
  const Vec2 start = flat_tip ? Vec2(t, 0) : t * Vec2(base::cos(half_angle), 1 - base::sin(half_angle));
  if (start.x > r) throw std::invalid_argument("tip_radius is too large for the diameter");
  std::vector<ProfileSegment> segments;
  if (t > 0) segments.push_back(flat_tip ? line(t, 0) : arc(start.x, start.y, 0, t));
  if (r > start.x) segments.push_back(line(r, start.y + (r - start.x) / base::tan(half_angle)));
  return up_to(std::move(segments), length);
}
AptCutter taper_to_apt(double tip_radius, double half_angle, double /*diameter*/, double length, bool /*flat_tip*/) {
  return {2 * tip_radius, tip_radius, 0, tip_radius, 0, half_angle, length};
}
/// The cone continues from the end of the ball to the top.
Sizes taper_from_apt(const AptCutter& apt) {
  if (!(has_plain_corner(apt) && has_ball(apt) && apt.b > 0)) return std::nullopt;
  const double top = 2 * (apt.r * base::cos(apt.b) + (apt.h - apt.r * (1 - base::sin(apt.b))) * base::tan(apt.b));
  return Sizes({apt.r, apt.b, top, apt.h, 0});
}

Profile cone_end_profile(double tip_half_angle, double tip_height, double half_angle, double diameter, double length) {
  const double r = diameter / 2, shoulder = tip_height * base::tan(tip_half_angle);
  if (shoulder > r) throw std::invalid_argument("tip_height: the first cone is wider there than the diameter");
  std::vector<ProfileSegment> segments{line(shoulder, tip_height)};
  if (r > shoulder) segments.push_back(line(r, tip_height + (r - shoulder) / base::tan(half_angle)));
  return up_to(std::move(segments), length);
}

// The table.

template <class Result, class... Size>
Result call(Result (*f)(Size...), std::span<const double> sizes) {
  return [&]<std::size_t... k>(std::index_sequence<k...>) {
    return f(static_cast<Size>(sizes[k])...);
  }(std::index_sequence_for<Size...>{});
}

/// f(sizes[0], sizes[1], …)
template <auto f>
auto of_sizes(std::span<const double> sizes) {
  return call(f, sizes);
}

template <class Result, class... Size>
constexpr std::size_t arity(Result (*)(Size...)) {
  return sizeof...(Size);
}

template <auto profile, std::size_t n>
constexpr CutterShape row(const char* name, const char* label, const char* description, const CutterSize (&sizes)[n]) {
  static_assert(arity(profile) == n, "a size for each argument of the profile");
  return {name, label, description, sizes, of_sizes<profile>, nullptr, nullptr};
}

template <auto profile, auto to_apt, std::size_t n>
constexpr CutterShape row(const char* name, const char* label, const char* description, const CutterSize (&sizes)[n],
                          Sizes (*from_apt)(const AptCutter&)) {
  static_assert(arity(profile) == n && arity(to_apt) == n, "a size for each argument");
  return {name, label, description, sizes, of_sizes<profile>, of_sizes<to_apt>, from_apt};
}

constexpr CutterSize kBall[] = {kDiameter, kLength};
constexpr CutterSize kFillet[] = {kDiameter, kCornerRadius, kLength};
constexpr CutterSize kTaper[] = {kTipRadius, kHalfAngle, kDiameter, kLength, kFlatTip};
constexpr CutterSize kConeEnd[] = {kTipHalfAngle, kTipHeight, kHalfAngle, kDiameter, kLength};

constexpr CutterShape kShapes[] = {
    row<ball_profile, ball_to_apt>("ball", "Ball", "Ball end mill", kBall, ball_from_apt),
    row<flat_profile, flat_to_apt>("flat", "Flat", "Flat end mill", kBall, flat_from_apt),
    row<fillet_profile, fillet_to_apt>("fillet", "Bull Nose", "Flat end mill with a rounded edge", kFillet,
                                       fillet_from_apt),
    row<taper_profile, taper_to_apt>("taper", "Taper", "Cone above a ball tip or a flat one, then a cylinder", kTaper,
                                     taper_from_apt),
    row<cone_end_profile>("cone_end", "Cone", "Sharp tip, a first cone, a second cone, then a cylinder", kConeEnd),
};

Tool make(std::string_view name, std::initializer_list<double> sizes) {
  return make_cutter(*find_cutter_shape(name), sizes);
}

}  // namespace

std::span<const CutterShape> cutter_shapes() {
  return kShapes;
}

const CutterShape* find_cutter_shape(std::string_view name) {
  const auto* found = std::ranges::find_if(kShapes, [&](const CutterShape& shape) { return shape.name == name; });
  return found == std::end(kShapes) ? nullptr : found;
}

Tool make_cutter(const CutterShape& shape, std::span<const double> sizes) {
  if (sizes.size() != shape.sizes.size())
    throw std::invalid_argument(std::string(shape.name) + " has " + std::to_string(shape.sizes.size()) + " sizes");
  std::vector<std::pair<std::string, double>> parameters;
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    check(shape.sizes[k], sizes[k]);
    parameters.emplace_back(shape.sizes[k].name, sizes[k]);
  }
  return {shape.name, std::move(parameters), shape.profile(sizes)};
}

std::optional<std::vector<double>> sizes_of(const Tool& tool, const CutterShape& shape) {
  std::vector<double> out;
  for (const CutterSize& size : shape.sizes) {
    const auto& all = tool.parameters();
    const auto found = std::ranges::find(all, size.name, &std::pair<std::string, double>::first);
    if (found == all.end()) return std::nullopt;
    out.push_back(found->second);
  }
  return out;
}

bool is_flag(const Tool& tool, std::string_view parameter) {
  const CutterShape* shape = find_cutter_shape(tool.kind());
  return shape && std::ranges::any_of(shape->sizes, [&](const CutterSize& size) {
           return size.name == parameter && size.unit == SizeUnit::Flag;
         });
}

namespace cutters {

Tool ball(double diameter, double length) {
  return make("ball", {diameter, length});
}

Tool flat(double diameter, double length) {
  return make("flat", {diameter, length});
}

Tool fillet(double diameter, double corner_radius, double length) {
  return make("fillet", {diameter, corner_radius, length});
}

Tool taper(double tip_radius, double half_angle, double diameter, double length, bool flat_tip) {
  return make("taper", {tip_radius, half_angle, diameter, length, flat_tip ? 1.0 : 0.0});
}

Tool cone_end(double tip_half_angle, double tip_height, double half_angle, double diameter, double length) {
  return make("cone_end", {tip_half_angle, tip_height, half_angle, diameter, length});
}

Tool profile(std::vector<ProfileSegment> segments, double length) {
  base::require_length(length, "length");
  if (segments.empty()) throw std::invalid_argument("segments must not be empty");
  return {"profile", {{"length", length}}, up_to(std::move(segments), length)};
}

}  // namespace cutters

}  // namespace riffler::tool
