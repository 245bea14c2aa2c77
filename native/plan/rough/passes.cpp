#include "plan/rough/passes.hpp"

#include <algorithm>
#include <utility>

#include "base/functions.hpp"
#include "geom/math.hpp"

namespace riffler::plan {

namespace {

constexpr double kMore = 1.5;  // spacings added to the step, so that a ramp begins in cleared cells

/// The points of a curve in order, and the length of the curve up to each point.
class Track {
 public:
  Track(std::vector<Vec2> points, const PassScene& scene) : points_(std::move(points)), scene_(scene) {
    at_.push_back(0);
    for (std::size_t k = 1; k < points_.size(); ++k)
      at_.push_back(at_.back() + glm::length(points_[k] - points_[k - 1]));
  }
  std::size_t size() const { return points_.size(); }
  double at(std::size_t k) const { return at_[k]; }
  const Vec2& point(std::size_t k) const { return points_[k]; }
  double length() const { return at_.back(); }
  /// The first point at least `length` from the start.
  std::size_t beyond(double length) const {
    return std::min(points_.size() - 1,
                    static_cast<std::size_t>(std::lower_bound(at_.begin(), at_.end(), length) - at_.begin()));
  }
  /// Point k, moved to the cleared side by a share of slightly more than the step, or less where the cutter must not
  /// be.
  Vec2 beside(std::size_t k, double share) const {
    const Vec2 along = points_[std::min(k + 2, points_.size() - 1)] - points_[k < 2 ? 0 : k - 2];
    const double size = glm::length(along);
    if (!(size > 0) || share <= 0) return points_[k];
    const Vec2 aside = scene_.side * Vec2(-along.y, along.x) / size;
    const double most = scene_.step + kMore * scene_.grid.spacing;
    for (double by = share * most; by > 0.1 * scene_.grid.spacing; by *= 0.7)
      if (const Vec2 p = points_[k] + by * aside; scene_.in[scene_.grid.nearest(p)]) return p;
    return points_[k];
  }

 private:
  std::vector<Vec2> points_;
  std::vector<double> at_;
  const PassScene& scene_;
};

/// Distance of a ramp from the curve after a share of its length: from 1 at the start to 0 at the end.
double beside_after(double share) {
  return 0.5 + 0.5 * base::cos(kPi * std::clamp(share, 0.0, 1.0));
}

/// Adds a pass along all points of a track. `walled`: the cutter touches material at the first point already.
void add_part(const Track& track, bool walled, const PassScene& scene, std::vector<Pass>& out) {
  Pass pass;
  if (walled) {
    const double ramp = std::min(scene.ramp, track.length());
    for (std::size_t k = track.beyond(ramp); k > 0; --k)
      pass.path.push_back(track.beside(k, beside_after((ramp - track.at(k)) / ramp)));
  }
  for (std::size_t k = 0; k < track.size(); ++k) pass.path.push_back(track.point(k));
  out.push_back(std::move(pass));
}

}  // namespace

void passes_along(const Curve& curve, const Layer& layer, const PassScene& scene, std::vector<Pass>& out) {
  std::vector<Vec2> points = curve.points;
  if (points.size() < 2) return;
  std::vector<char> active;
  for (const Vec2& p : points) active.push_back(layer.touches(p));
  if (curve.closed) {
    const auto idle = std::find(active.begin(), active.end(), 0) - active.begin();
    if (idle == static_cast<std::ptrdiff_t>(active.size())) {
      out.push_back({std::move(points), true});
      return;
    }
    std::rotate(points.begin(), points.begin() + idle, points.end());
    std::rotate(active.begin(), active.begin() + idle, active.end());
    points.push_back(points.front()), active.push_back(0);
  }
  for (std::size_t k = 0; k < points.size();) {
    if (!active[k]) {
      ++k;
      continue;
    }
    std::size_t last = k;
    double idle = 0;  // length since the last active point
    for (std::size_t i = k + 1; i < points.size() && idle <= scene.radius; ++i) {
      idle = active[i] ? 0 : idle + glm::length(points[i] - points[i - 1]);
      if (active[i]) last = i;
    }
    std::size_t first = k;
    for (double back = 0; first > 0 && !active[first - 1] && back < 0.5 * scene.radius &&
                          (first == k || !layer.spares(points[first], kSpared));
         --first)
      back += glm::length(points[first] - points[first - 1]);
    const std::size_t end = std::min(last + 2, points.size());
    const auto at = [&](std::size_t i) { return points.begin() + static_cast<std::ptrdiff_t>(i); };
    double cuts = 0;
    for (std::size_t i = k + 1; i <= last; ++i) cuts += glm::length(points[i] - points[i - 1]);
    if (end - first > 1 && cuts >= scene.least) add_part(Track({at(first), at(end)}, scene), active[first], scene, out);
    k = last + 1;
  }
}

std::vector<Vec2> round_from(const Pass& pass, std::size_t start, const PassScene& scene) {
  std::vector<Vec2> points;
  const std::size_t n = pass.path.size();
  for (std::size_t k = 0; k < 2 * n; ++k) points.push_back(pass.path[(start + k) % n]);
  const Track track(std::move(points), scene);
  const double ramp = std::min(scene.ramp, 0.5 * track.at(n));
  std::vector<Vec2> out;
  for (std::size_t k = 0; k <= n + track.beyond(ramp) && k < track.size(); ++k)
    out.push_back(track.beside(k, beside_after(track.at(k) / ramp)));
  return out;
}

}  // namespace riffler::plan
