#include "riffler/plan/swarf.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "base/functions.hpp"
#include "geom/math.hpp"
#include "mesh/closest.hpp"
#include "riffler/base/check.hpp"
#include "riffler/base/parallel.hpp"
#include "riffler/plan/cc_frame.hpp"
#include "riffler/plan/contact_location.hpp"

namespace riffler::plan {

namespace {

constexpr int kHeights = 9;        // heights at which flank and wall are compared
constexpr double kWidest = 1.05;   // rad: largest lean of a ruling along the feed
constexpr int kDirections = 15;    // directions tried over that range before refining the best
constexpr int kRefinements = 24;   // golden section steps: kWidest · 2 / 7 · 0.618²⁴ = 3e-6 rad
constexpr double kProgress = 0.4;  // fraction of a step that the foot must follow; it lags behind on an edge
constexpr double kUpright = 0.1;   // tolerances per rad: improvement that a leaning ruling must bring

/// The flank above the ball's centre: the axis point `s` above it is `radius + s · widening` away from a plane that the
/// flank touches.
struct Flank {
  double radius, widening, length;

  double at(double s) const { return radius + s * widening; }
};

Flank flank_of(const Tool& tool, double radius) {
  const double ball = CutterSupport(tool).ball_radius();
  if (!(ball > 0) || std::abs(ball - radius) > 1e-9 * radius)
    throw std::invalid_argument("tool: swarf cuts need a cutter whose ball end has the radius of the path");
  const auto& segments = tool.profile().segments();
  Vec2 from{0, 0};
  for (const tool::ProfileSegment& s : segments) {
    if (!s.centre && s.to.y > from.y && from.y > 0) {
      const Vec2 way = glm::normalize(s.to - from);
      return {radius, way.x, s.to.y - radius};
    }
    from = s.to;
  }
  throw std::invalid_argument("tool: the cutter has no straight flank");
}

class Wall {
 public:
  Wall(const Mesh& part, const Flank& flank, const SwarfOptions& options)
      : closest_(part), flank_(flank), options_(options) {}

  struct Fit {
    Vec3 axis;
    double height, error, cost;
  };

  /// The best axis at point k of the path.
  Fit best(const PencilPath& path, std::size_t k) const {
    const Vec3 centre = path.centres[k];
    const Vec3 normal = glm::normalize(centre - path.contacts[k][options_.side]);
    const CcFrame frame = cc_frame(feed_at(path, k), normal);
    const Vec3 other = path.normals[k][1 - options_.side];
    const Vec3 up = glm::dot(frame.y, other) >= 0 ? frame.y : -frame.y;  // away from the surface of the other contact
    const double height = extent(centre, up);
    if (!(height > 0)) return {up, 0, kInfinity, kInfinity};
    const auto fit = [&](double lean) {
      const Vec3 way = base::cos(lean) * up + base::sin(lean) * frame.x;
      return this->fit(centre, way, height / base::cos(lean), lean);
    };
    double at = 0;
    Fit best = fit(0);
    for (int i = 1; i < kDirections; ++i) {
      const double lean = kWidest * (i % 2 ? -1 : 1) * ((i + 1) / 2) / (kDirections / 2);
      if (const Fit f = fit(lean); f.cost < best.cost) best = f, at = lean;
    }
    return refine(fit, at, best);
  }

 private:
  /// Golden section search around the best of the directions tried.
  template <class Function>
  Fit refine(const Function& fit, double at, Fit best) const {
    const double golden = 0.6180339887498949, step = kWidest / (kDirections / 2);
    double low = at - step, high = at + step;
    double a = high - golden * (high - low), b = low + golden * (high - low);
    Fit at_a = fit(a), at_b = fit(b);
    for (int i = 0; i < kRefinements; ++i) {
      if (at_a.cost < at_b.cost)
        high = b, b = a, at_b = at_a, a = high - golden * (high - low), at_a = fit(a);
      else
        low = a, a = b, at_a = at_b, b = low + golden * (high - low), at_b = fit(b);
      for (const Fit& f : {at_a, at_b})
        if (f.cost < best.cost) best = f;
    }
    return best;
  }

  /// How far the wall extends upwards from the ball's centre: as long as the nearest point rises with the query point.
  double extent(const Vec3& centre, const Vec3& up) const {
    const double most = options_.height.value_or(flank_.length), step = most / std::ceil(4 * most / flank_.radius);
    double foot = 0;
    for (int k = 1; k * step < most * (1 + 1e-12); ++k) {
      const mesh::Closest::Hit hit = closest_(centre + k * step * up, 2 * flank_.at(k * step));
      if (hit.triangle < 0) break;
      const double before = foot;
      foot = std::max(foot, glm::dot(hit.point - centre, up));
      if (foot < before + kProgress * step) break;
    }
    return std::min(foot, most);
  }

  /// The axis through the centre near the given direction whose point at `height` has the flank's distance from the
  /// wall.
  Fit fit(const Vec3& centre, const Vec3& way, double height, double lean) const {
    Vec3 top = centre + height * way;
    for (int i = 0; i < 4; ++i) {
      const mesh::Closest::Hit hit = closest_(top);
      if (!(hit.distance > 0)) return {way, height, kInfinity, kInfinity};
      top += (flank_.at(height) - hit.distance) * ((top - hit.point) / hit.distance);
    }
    const Vec3 axis = glm::normalize(top - centre);
    double error = 0;
    for (int j = 0; j <= kHeights; ++j) {
      const double s = height * j / kHeights;
      error = std::max(error, std::abs(closest_(centre + s * axis).distance - flank_.at(s)));
    }
    const double leaning = kUpright * options_.tolerance * lean;
    return {axis, height, error, std::sqrt(error * error + leaning * leaning)};
  }

  mesh::Closest closest_;
  Flank flank_;
  const SwarfOptions& options_;
};

void check(const PencilPath& path, const SwarfOptions& options) {
  if (options.side != 0 && options.side != 1) throw std::invalid_argument("side must be 0 or 1");
  base::require_tolerance(options.tolerance);
  if (path.size() < 2) throw std::invalid_argument("path has fewer than two points");
}

}  // namespace

Swarf swarf(const PencilPath& path, const Mesh& part, const Tool& tool, const SwarfOptions& options,
            const Progress& progress) {
  check(path, options);
  const Flank flank = flank_of(tool, path.radius);
  if (options.height && !(*options.height > 0 && *options.height <= flank.length))
    throw std::invalid_argument("height must be positive and not above the cutter's flank, which ends " +
                                std::to_string(flank.length) + " mm above the ball's centre");
  const Wall wall(part, flank, options);
  Swarf out{path, std::vector<double>(path.size()), std::vector<double>(path.size()), {}};
  out.path.axes.resize(path.size()), out.path.keys.clear(), out.path.interpolation.clear();
  base::parallel_for(
      path.size(), 16,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
          const Wall::Fit fit = wall.best(path, k);
          out.path.axes[k] = fit.axis, out.height[k] = fit.height, out.error[k] = fit.error;
        }
      },
      progress);
  for (std::size_t k = 0; k < path.size(); ++k)
    if (out.error[k] <= options.tolerance) {
      if (out.fits.empty() || out.fits.back()[1] + 1 != k) out.fits.push_back({k, k});
      out.fits.back()[1] = k;
    }
  return out;
}

}  // namespace riffler::plan
