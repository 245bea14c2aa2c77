#include "plan/row_axes.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "geom/directions.hpp"
#include "geom/math.hpp"
#include "riffler/base/check.hpp"
#include "riffler/base/parallel.hpp"
#include "riffler/geom/pose.hpp"
#include "riffler/plan/contact_location.hpp"
#include "riffler/plan/least_tilt.hpp"

namespace riffler::plan {

namespace {

constexpr double kSagShare = 0.25;  // of the tolerance, for the centre's distance from the line while the axis turns
constexpr double kSame = 1e-9;      // rad between axes that count as one
constexpr double kGrid = kPi / 15;  // rad between the axes of maps
constexpr double kStations = 1.5;   // grid steps by which the axis may turn from one station to the next
constexpr double kLongestDivision = 1.0;  // mm
constexpr double kRoom = 0.5;             // mm between shank or holder and the part along axes of least tilt
constexpr std::size_t kMaxPoints = 20'000'000;

std::vector<double> grid(double most) {
  const int n = static_cast<int>(std::floor(most / kGrid));
  std::vector<double> out;
  for (int k = -n; k <= n; ++k) out.push_back(k * kGrid);
  return out;
}

}  // namespace

void validate(const AxisRule& rule) {
  const auto inside = [](double angle) { return std::abs(angle) < kPi / 2; };
  if (!inside(rule.lean.inclination) || !inside(rule.lean.tilt))
    throw std::invalid_argument("orientation: lead and tilt must be less than 90°");
  const bool aims = rule.kind == AxisRule::Kind::Towards || rule.kind == AxisRule::Kind::Away;
  if (aims && rule.target.empty()) throw std::invalid_argument("orientation: needs a point or a curve");
  for (const Vec3& p : rule.target)
    if (!geom::finite(p)) throw std::invalid_argument("orientation: a point that is not finite");
  if (!(rule.max_tilt > 0 && rule.max_tilt <= kMaxTilt + 1e-9))
    throw std::invalid_argument("max_tilt must be above 0 and at most 80° (1.396 rad)");
  base::require_positive(rule.max_turn, "max_turn", base::kPositiveAndFinite);
}

double ball_for_rows(const Tool& tool) {
  const double radius = CutterSupport(tool).ball_radius();
  if (!(radius > 0))
    throw std::invalid_argument(
        "tool: " + tool.name() +
        " has no ball at its tip; axes that change along a row need one, because a ball "
        "leaves the same ridges along every axis: take a ball or taper, or a fixed orientation");
  return radius;
}

struct RowAxes::Line {
  std::vector<Vec3> centres, axes;
  std::vector<MoveKind> kinds;
  std::vector<double> places;  // mm along the line
  std::vector<char> inserted;  // whether the point may be left out again
};

RowAxes::RowAxes(const AxisRule& rule, const Mesh& part, const Vec3& up, const collide::Assembly& tool,
                 const collide::Collider& collider, double distance, double tolerance)
    : rule_(rule),
      part_(part),
      up_(up),
      tool_(tool),
      roomy_(tool.tool().with_margins(kRoom, kRoom)),
      collider_(collider),
      distance_(distance),
      tolerance_(tolerance),
      radius_(ball_for_rows(tool.tool())) {
  // While the axis turns by θ, a centre r along it leaves the line by at most r θ² / 8.
  step_ = std::min(std::sqrt(8 * kSagShare * tolerance_ / radius_) / rule.max_turn, kLongestDivision);
}

RowAxes::Line RowAxes::divided(const std::vector<Vec3>& centres, const std::vector<MoveKind>& kinds) const {
  Line out;
  double place = 0;
  const auto add = [&](const Vec3& p, MoveKind kind, bool inserted) {
    if (!out.centres.empty()) place += glm::length(p - out.centres.back());
    out.centres.push_back(p), out.kinds.push_back(kind), out.places.push_back(place), out.inserted.push_back(inserted);
    if (out.centres.size() > kMaxPoints)
      throw std::invalid_argument("tolerance: a line of more than twenty million points; take a larger one");
  };
  for (std::size_t k = 0; k < centres.size(); ++k) {
    if (k > 0) {
      const double length = glm::length(centres[k] - centres[k - 1]);
      const int n = static_cast<int>(std::ceil(length / step_));
      for (int i = 1; i < n; ++i) add(glm::mix(centres[k - 1], centres[k], static_cast<double>(i) / n), kinds[k], true);
    }
    add(centres[k], kinds[k], false);
  }
  out.axes.assign(out.centres.size(), up_);
  return out;
}

Vec3 RowAxes::target_near(const Vec3& p) const {
  Vec3 best = rule_.target.front();
  for (std::size_t k = 1; k < rule_.target.size(); ++k) {
    const Vec3 a = rule_.target[k - 1], way = rule_.target[k] - a;
    const double square = glm::dot(way, way);
    const Vec3 q = square > 0 ? a + std::clamp(glm::dot(p - a, way) / square, 0.0, 1.0) * way : a;
    if (glm::length(q - p) < glm::length(best - p)) best = q;
  }
  return best;
}

Vec3 RowAxes::in_cone(const Vec3& axis) const {
  if (geom::angle_between(axis, up_) <= rule_.max_tilt) return axis;
  // For an axis straight down no side is nearer: then any will do, and the same one for the same axis.
  if (glm::dot(axis, up_) < -1 + 1e-9) return in_cone(glm::normalize(axis + 1e-3 * cc_frame({1, 0, 0}, up_).x));
  return project({up_, rule_.max_tilt, true}, axis);
}

void RowAxes::by_rule(Line& line, const Progress& progress) const {
  const std::size_t n = line.centres.size();
  const auto axis_at = [&](std::size_t k) {
    const Vec3& c = line.centres[k];
    if (rule_.kind != AxisRule::Kind::Lean) {
      const Vec3 way = target_near(c) - c;
      const double length = glm::length(way);
      return length > 0 ? (rule_.kind == AxisRule::Kind::Towards ? way : -way) / length : up_;
    }
    const Vec3 away = c - part_(c).point;
    const double length = glm::length(away);
    const Vec3 normal = length > 0 ? away / length : up_;
    const Vec3 feed = line.centres[std::min(k + 1, n - 1)] - line.centres[k > 0 ? k - 1 : 0];
    return axis_of(cc_frame(feed, normal), rule_.lean);
  };
  base::parallel_for(
      n, 64,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) line.axes[k] = in_cone(axis_at(k));
      },
      progress);
}

/// Upright where the tool is free so. Elsewhere, and as far around as turning takes, axes of the maps.
void RowAxes::of_least_tilt(Line& line, const Progress& progress) const {
  const std::size_t n = line.centres.size();
  std::vector<char> stuck(n);
  base::parallel_for(
      n, 16,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k)
          stuck[k] = !collider_.keeps(roomy_, {line.centres[k] - radius_ * up_, up_}, distance_ - 0.5 * tolerance_);
      },
      base::part(progress, 0, 0.3));
  const double around = rule_.max_tilt / rule_.max_turn;
  std::vector<std::pair<double, double>> runs;
  for (std::size_t k = 0; k < n; ++k) {
    if (!stuck[k]) continue;
    const double from = std::max(0.0, line.places[k] - around),
                 to = std::min(line.places.back(), line.places[k] + around);
    if (runs.empty() || from > runs.back().second)
      runs.emplace_back(from, to);
    else
      runs.back().second = to;
  }
  for (std::size_t k = 0; k < runs.size(); ++k) {
    base::report(progress, 0.3 + 0.7 * static_cast<double>(k) / static_cast<double>(runs.size()));
    tilt_run(line, runs[k].first, runs[k].second);
  }
}

/// Sets the axes of the points between two places of a line: free axes of least tilt at stations, and between these the
/// great circle. Stations where nothing is free keep the axis upright; the collision is found later.
void RowAxes::tilt_run(Line& line, double from, double to) const {
  const double spacing = kStations * kGrid / rule_.max_turn;
  const int spans = std::max(1, static_cast<int>((to - from) / spacing));
  PencilPath path;
  path.radius = radius_;
  std::size_t at = 0;
  for (int k = 0; k <= spans; ++k) {
    const double place = from + (to - from) * k / spans;
    while (at + 2 < line.places.size() && line.places[at + 1] < place) ++at;
    const std::size_t after = std::min(at + 1, line.places.size() - 1);
    const double width = line.places[after] - line.places[at];
    const double share = width > 0 ? std::clamp((place - line.places[at]) / width, 0.0, 1.0) : 0;
    const Vec3 c = glm::mix(line.centres[at], line.centres[after], share);
    path.centres.push_back(c);
    const Vec3 below = c - radius_ * up_;  // maps are about the direction from contact to centre: here upright
    path.contacts.push_back({below, below}), path.normals.push_back({up_, up_});
  }
  TiltRule rule;
  rule.map.inclinations = rule.map.tilts = grid(rule_.max_tilt);
  rule.map.clearance = distance_, rule.map.tolerance = 0.5 * tolerance_;
  rule.map.limit = AxisLimit{up_, rule_.max_tilt, false};
  rule.max_change = kStations * kGrid + 1e-9;
  std::vector<Vec3> axes(path.size(), up_);
  const auto part_of = [&](std::size_t begin, std::size_t end) {
    PencilPath part;
    part.radius = radius_;
    const auto cut = [&](auto& v) {
      return std::remove_reference_t<decltype(v)>(v.begin() + static_cast<std::ptrdiff_t>(begin),
                                                  v.begin() + static_cast<std::ptrdiff_t>(end));
    };
    part.centres = cut(path.centres), part.contacts = cut(path.contacts), part.normals = cut(path.normals);
    return part;
  };
  for (std::size_t begin = 0; begin < path.size();) {
    TiltAnswer found = least_tilt(part_of(begin, path.size()), roomy_, collider_, rule);
    std::size_t end = path.size();
    if (!found.found) {
      end = begin + found.point;
      if (end > begin) found = least_tilt(part_of(begin, end), roomy_, collider_, rule);
    }
    if (found.found) std::copy(found.axes.begin(), found.axes.end(), axes.begin() + static_cast<std::ptrdiff_t>(begin));
    if (end == begin)  // where there is no room, without it
      if (const TiltAnswer close = least_tilt(part_of(begin, begin + 1), tool_, collider_, rule); close.found)
        axes[begin] = close.axes.front();
    begin = std::max(end, begin + 1);
  }
  for (std::size_t k = 0; k < line.places.size(); ++k) {
    if (line.places[k] < from || line.places[k] > to) continue;
    const double u = to > from ? (line.places[k] - from) / (to - from) * spans : 0;
    const std::size_t i = std::min(static_cast<std::size_t>(u), path.size() - 2);
    line.axes[k] = geom::slerp(axes[i], axes[i + 1], std::min(u - static_cast<double>(i), 1.0));
  }
}

/// The mean over one radius of the line about each place. Beyond its ends the line counts as constant.
void RowAxes::average(Line& line) const {
  const std::size_t n = line.centres.size();
  std::vector<Vec3> sum(n, Vec3(0));  // integral of the axis from the beginning
  for (std::size_t k = 1; k < n; ++k)
    sum[k] = sum[k - 1] + 0.5 * (line.places[k] - line.places[k - 1]) * (line.axes[k] + line.axes[k - 1]);
  const double end = line.places.back();
  const auto integral = [&](double s, std::size_t& at) {
    if (s <= 0) return s * line.axes.front();
    if (s >= end) return sum[n - 1] + (s - end) * line.axes.back();
    while (line.places[at + 1] < s) ++at;
    const double width = line.places[at + 1] - line.places[at], u = width > 0 ? (s - line.places[at]) / width : 0;
    const Vec3 here = glm::mix(line.axes[at], line.axes[at + 1], u);
    return sum[at] + 0.5 * (s - line.places[at]) * (line.axes[at] + here);
  };
  std::vector<Vec3> out(n);
  std::size_t low = 0, high = 0;
  for (std::size_t k = 0; k < n; ++k)
    out[k] =
        glm::normalize(integral(line.places[k] + 0.5 * radius_, high) - integral(line.places[k] - 0.5 * radius_, low));
  line.axes = std::move(out);
}

/// Limits the change: a pass forwards, one backwards, the middle between both, and another pass forwards, because the
/// middle may turn faster than either. All axes are within a convex cone, so the middle exists.
void RowAxes::limit(Line& line) const {
  const std::size_t n = line.centres.size();
  const auto follow = [&](const Vec3& last, const Vec3& wanted, double length) {
    const double angle = geom::angle_between(last, wanted), most = rule_.max_turn * length;
    return angle <= most ? wanted : geom::slerp(last, wanted, most / angle);
  };
  std::vector<Vec3> forwards = line.axes, backwards = line.axes;
  for (std::size_t k = 1; k < n; ++k)
    forwards[k] = follow(forwards[k - 1], line.axes[k], line.places[k] - line.places[k - 1]);
  for (std::size_t k = n - 1; k-- > 0;)
    backwards[k] = follow(backwards[k + 1], line.axes[k], line.places[k + 1] - line.places[k]);
  for (std::size_t k = 0; k < n; ++k) line.axes[k] = glm::normalize(forwards[k] + backwards[k]);
  for (std::size_t k = 1; k < n; ++k)
    line.axes[k] = follow(line.axes[k - 1], line.axes[k], line.places[k] - line.places[k - 1]);
}

/// Leaves out inserted points between equal axes.
CutLine RowAxes::poses(const Line& line) const {
  CutLine out;
  for (std::size_t k = 0; k < line.centres.size(); ++k) {
    if (line.inserted[k] && geom::angle_between(line.axes[k], out.poses.back().axis) < kSame &&
        geom::angle_between(line.axes[k], line.axes[k + 1]) < kSame)
      continue;
    out.poses.push_back({line.centres[k] - radius_ * line.axes[k], line.axes[k]});
    out.kinds.push_back(line.kinds[k]);
  }
  return out;
}

CutLine RowAxes::operator()(const std::vector<Vec3>& centres, const std::vector<MoveKind>& kinds,
                            const Progress& progress) const {
  Line line = divided(centres, kinds);
  if (rule_.kind == AxisRule::Kind::LeastTilt) {
    of_least_tilt(line, progress);
  } else {
    by_rule(line, progress);
    average(line);
  }
  limit(line);
  return poses(line);
}

}  // namespace riffler::plan
