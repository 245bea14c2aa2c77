#include "bench/dense_path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/dense_sweep.hpp"

namespace riffler::reference {

namespace {

constexpr int kHalvings = 14;  // 16 384 times a move
constexpr double kFinest = 1.0 / (1 << kHalvings);
constexpr int kRefinements = 16;  // where the distance stays the same for a while there is nothing to refine

/// Least of f between a and b, where f has one minimum.
template <class F>
double golden_section(const F& f, double a, double b) {
  const double golden = 0.6180339887498949;
  double x = b - golden * (b - a), y = a + golden * (b - a), fx = f(x), fy = f(y);
  for (int i = 0; i < 30; ++i) {
    if (fx < fy)
      b = y, y = x, fy = fx, x = b - golden * (b - a), fx = f(x);
    else
      a = x, x = y, fx = fy, y = a + golden * (b - a), fy = f(y);
  }
  return std::min(fx, fy);
}

}  // namespace

DensePath::DensePath(const Profile& profile, std::span<const Pose> poses)
    : profile_(profile), size_(std::hypot(profile.length(), profile.max_radius())) {
  for (std::size_t k = 0; k + 1 < poses.size(); ++k) motions_.emplace_back(poses[k], poses[k + 1]);
}

double DensePath::at(const Motion& motion, const Vec3& p, double t) const {
  const Vec3 w = p - motion.tip(t), o = motion.axis(t);
  const double z = glm::dot(w, o);
  return profile_distance(profile_, glm::length(w - z * o), z);
}

double DensePath::rate(const Motion& motion, const Vec3& p) const {
  const double way = glm::length(motion.to().tip - motion.from().tip);
  const double arm = std::min(size_, glm::length(p - motion.tip(0.5)) + way / 2);
  return way + motion.angle() * arm;
}

DensePath::Near DensePath::near(const Vec3& p, double reach) const {
  Near near;
  near.path_ = this, near.reach_ = reach;
  std::vector<std::pair<double, std::size_t>> found;
  for (std::size_t k = 0; k < motions_.size(); ++k) {
    const double bound = at(motions_[k], p, 0.5) - rate(motions_[k], p) / 2;
    if (bound < 2 * reach) found.emplace_back(bound, k);
  }
  std::sort(found.begin(), found.end());  // the nearest first: what they leave is less
  for (const auto& [bound, k] : found) near.moves_.push_back(k);
  return near;
}

double DensePath::least(const std::vector<std::size_t>& moves, const Vec3& p, double best, double enough) const {
  for (const std::size_t k : moves) {
    best = least(motions_[k], p, best, enough);
    if (best < enough) break;
  }
  return best;
}

double DensePath::least(const Motion& motion, const Vec3& p, double best, double enough) const {
  struct Part {
    double a, b, fa, fb;
  };
  const double rate_here = rate(motion, p);
  const auto f = [&](double t) { return at(motion, p, t); };
  int refinements = 0;
  double lowest = std::numeric_limits<double>::infinity();  // of the finest parts so far
  Part parts[kHalvings + 2];                                // depth first: at most one part waits on each level
  int count = 0;
  parts[count++] = {0, 1, f(0), f(1)};
  best = std::min({best, parts[0].fa, parts[0].fb});
  while (count > 0 && best >= enough) {
    const Part part = parts[--count];
    const double width = part.b - part.a;
    if ((part.fa + part.fb - rate_here * width) / 2 >= best) continue;
    if (width <= kFinest) {
      const bool record = part.fa + part.fb < lowest;
      if (record) lowest = part.fa + part.fb;
      if (record || refinements++ < kRefinements)
        best = std::min(best, golden_section(f, std::max(0.0, part.a - width), std::min(1.0, part.b + width)));
      continue;
    }
    const double t = (part.a + part.b) / 2, ft = f(t);
    best = std::min(best, ft);
    const Part low{part.a, t, part.fa, ft}, high{t, part.b, ft, part.fb};
    const bool low_first = part.fa < part.fb;
    parts[count++] = low_first ? high : low;
    parts[count++] = low_first ? low : high;
  }
  return best;
}

}  // namespace riffler::reference
