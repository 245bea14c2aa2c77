#include "riffler/session/path_guide.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "geom/math.hpp"

namespace riffler::session {

namespace {

// Edges of the path that one search crosses at most. A hand moves a tool by less than 2 mm a step.
constexpr int kEdges = 256;
constexpr double kTurn = 1e-5;  // rad, for derivatives of the tip's place
constexpr double kFar = 10;     // mm: a tool moves by less in a step

std::size_t checked(const plan::PencilPath& path, std::size_t point) {
  if (path.size() == 0) throw std::invalid_argument("the path has no points");
  if (point >= path.size())
    throw std::invalid_argument("point " + std::to_string(point) + ": the path has " + std::to_string(path.size()) +
                                ", from 0");
  return point;
}

}  // namespace

PathGuide::PathGuide(const plan::PencilPath& path, const Tool& tool, std::size_t point, const Vec3& axis, bool slides)
    : path_(path), cutter_(tool), slides_(slides) {
  checked(path, point);
  pose_ = plan::location_on_path(cutter_, path_, point, plan::unit_axis(axis, "axis"));
  station_ = static_cast<double>(point);
}

void PathGuide::go_to(std::size_t point) {
  pose_ = plan::location_on_path(cutter_, path_, checked(path_, point), pose_.axis);
  station_ = static_cast<double>(point);
}

/// The largest station: of an open path its last point; of a closed one the first point again.
double PathGuide::last() const {
  return static_cast<double>(path_.closed ? path_.size() : path_.size() - 1);
}

/// A station on the path: beyond an open path's ends it is the end.
double PathGuide::wrapped(double station) const {
  if (!path_.closed) return std::clamp(station, 0.0, last());
  const double rest = std::fmod(station, last());
  return rest < 0 ? rest + last() : rest;
}

std::size_t PathGuide::point() const {
  return static_cast<std::size_t>(std::lround(station_)) % path_.size();
}

/// False where the cutter cannot touch the path with this axis.
bool PathGuide::tip_at(double station, const Vec3& axis, Vec3& tip) const noexcept {
  try {
    const double s = wrapped(station), whole = std::floor(s), part = s - whole;
    const std::size_t k = static_cast<std::size_t>(whole) % path_.size();
    tip = plan::location_on_path(cutter_, path_, k, axis).tip;
    if (part > 0) tip = glm::mix(tip, plan::location_on_path(cutter_, path_, (k + 1) % path_.size(), axis).tip, part);
    return geom::finite(tip);
  } catch (...) {
    return false;
  }
}

/// The station whose tip is nearest to the wanted one, found by walking from the last station while the distance falls.
bool PathGuide::nearest(const Pose& wanted, double& station) const noexcept {
  double best = station_, closest = 0;
  Vec3 tip;
  if (!tip_at(best, wanted.axis, tip)) return false;
  const Vec3 before = tip;
  closest = glm::length(tip - wanted.tip);
  for (const int step : {1, -1}) {
    double from = station_;
    Vec3 start = before;
    for (int k = 0; k < kEdges; ++k) {
      // The rest of the edge on which `from` lies, in the direction of the walk.
      const double to = step > 0 ? std::floor(from) + 1 : std::ceil(from) - 1;
      if (!path_.closed && (to < 0 || to > last())) break;
      Vec3 end;
      if (!tip_at(to, wanted.axis, end)) break;
      const Vec3 edge = end - start;
      const double square = glm::dot(edge, edge);
      const double t = square > 0 ? std::clamp(glm::dot(wanted.tip - start, edge) / square, 0.0, 1.0) : 1;
      const double distance = glm::length(start + t * edge - wanted.tip);
      if (distance < closest) closest = distance, best = from + t * (to - from);
      if (t < 1) break;
      from = to, start = end;
    }
  }
  station = wrapped(best);
  return true;
}

Pose PathGuide::settled(const Pose& wanted) noexcept {
  double station = station_;
  Vec3 tip;
  Pose to = wanted;
  if (!tip_at(station_, to.axis, tip)) to.axis = pose_.axis;  // the cutter cannot touch with that axis
  if (slides_ && !nearest(to, station)) station = station_;
  if (!tip_at(station, to.axis, tip)) return pose_;
  station_ = station;
  return pose_ = {tip, to.axis};
}

PathGuide::Freedoms PathGuide::freedoms() const noexcept {
  Freedoms out;
  const Vec3 u = geom::any_perpendicular(pose_.axis);
  out.turns[0].angular = u, out.turns[1].angular = glm::cross(pose_.axis, u);
  for (Twist& turn : out.turns) {
    Vec3 ahead, behind;
    if (tip_at(station_, geom::rotate_about(pose_.axis, turn.angular, kTurn), ahead) &&
        tip_at(station_, geom::rotate_about(pose_.axis, turn.angular, -kTurn), behind))
      turn.linear = (ahead - behind) / (2 * kTurn);
  }
  // On an edge its direction, at a point that of both edges; on an open path's ends that of the only one.
  const double from = std::ceil(station_) - 1, to = std::floor(station_) + 1;
  Vec3 start, end;
  if (!slides_ || path_.size() < 2 || !tip_at(from, pose_.axis, start) || !tip_at(to, pose_.axis, end)) return out;
  const double length = glm::length(end - start);
  if (!(length > 0)) return out;
  out.slide.linear = (end - start) / length;
  out.back = to_end(-1), out.on = to_end(1);
  return out;
}

/// mm along the path to its end against or along its direction; for a closed path, and far from the end, at least what
/// a tool moves in a step.
double PathGuide::to_end(int step) const noexcept {
  if (path_.closed) return kFar;
  double left = 0, at = station_;
  while (left < kFar && (step > 0 ? at < last() : at > 0)) {
    const double next = step > 0 ? std::floor(at) + 1 : std::ceil(at) - 1;
    const auto k = static_cast<std::size_t>(std::min(at, next));
    left += std::abs(next - at) * glm::length(path_.centres[k + 1] - path_.centres[k]);
    at = next;
  }
  return left;
}

}  // namespace riffler::session
