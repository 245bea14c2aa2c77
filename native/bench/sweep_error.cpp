#include "bench/sweep_error.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "reference/swept_path.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::bench {

namespace {

using reference::SweptPath;

/// Sine of the angle to the surface, 1/√5, below which a ray grazes: moving it sideways moves its end more than twice
/// as far.
constexpr double kSteepest = 0.44721359549995793;
constexpr int kPoints = 12;  // per ray

struct Ray {
  const dexel::Grid* grid;
  int i, j;
};

bool cut(const Ray& r) {
  const std::span<const dexel::Span> spans = r.grid->ray(r.i, r.j);
  const Box3& box = r.grid->box();
  return spans.size() != 1 || spans[0].near != box.lower.z || spans[0].far != box.upper.z;
}

std::vector<Ray> chosen(const dexel::Grid& grid, int count, std::mt19937_64& random) {
  std::vector<Ray> all, out;
  for (int i = 0; i < grid.nu(); ++i)
    for (int j = 0; j < grid.nv(); ++j)
      if (const Ray r{&grid, i, j}; cut(r)) all.push_back(r);
  if (all.empty()) return out;
  while (static_cast<int>(out.size()) < count) {
    Ray r = all[random() % all.size()];
    if (out.size() % 4 == 3) {
      r.i = std::clamp(r.i + static_cast<int>(random() % 5) - 2, 0, grid.nu() - 1);
      r.j = std::clamp(r.j + static_cast<int>(random() % 5) - 2, 0, grid.nv() - 1);
    }
    out.push_back(r);
  }
  return out;
}

class Comparison {
 public:
  Comparison(const Ray& ray, const SweptPath& path, double tolerance)
      : ray_(ray), path_(path), tolerance_(tolerance), reach_(8 * tolerance) {}

  SweepErrors run() {
    const Box3& box = ray_.grid->box();
    const std::span<const dexel::Span> spans = ray_.grid->ray(ray_.i, ray_.j);
    for (const dexel::Span& s : spans) {
      if (s.near > box.lower.z) out_.ends.push_back(end(s.near));
      if (s.far < box.upper.z) out_.ends.push_back(end(s.far));
    }
    double before = box.lower.z;
    for (const dexel::Span& s : spans) {  // the middle of every span and gap, however thin
      if (s.near > before) point((before + s.near) / 2);
      point((s.near + s.far) / 2);
      before = s.far;
    }
    for (int k = 0; k < kPoints; ++k) point(box.lower.z + (k + 0.37) / kPoints * (box.upper.z - box.lower.z));
    return std::move(out_);
  }

 private:
  Vec3 world(const Vec3& local) const { return to_world(ray_.grid->axis(), local); }
  Vec3 on_ray(double s) const { return world({ray_.grid->shifted_u(ray_.i), ray_.grid->shifted_v(ray_.j), s}); }

  void point(double s) {
    bool solid = false;
    for (const dexel::Span& span : ray_.grid->ray(ray_.i, ray_.j)) solid = solid || (s >= span.near && s <= span.far);
    const Vec3 p = on_ray(s);
    const SweptPath::Near near = path_.near(p, reach_);
    ++out_.points;
    out_.wrong += solid ? near.deeper(p, tolerance_) : near.farther(p, tolerance_);
  }

  /// Distance from p, along ±d, to where inside and outside meet; `reach` if that is farther.
  double crossing(const SweptPath::Near& near, const Vec3& p, const Vec3& d, double reach) const {
    const double fine = std::max(1e-9, 1e-5 * tolerance_);
    for (double e = reach / 4096; e <= reach; e *= 2) {
      const bool low = near.inside(p - e * d);
      if (low == near.inside(p + e * d)) continue;
      double a = -e, b = e;
      while (b - a > fine) {
        const double middle = (a + b) / 2;
        (near.inside(p + middle * d) == low ? a : b) = middle;
      }
      return std::abs(a + b) / 2;
    }
    return reach;
  }

  EndError end(double s) const {
    const Vec3 p = on_ray(s), d = world({0, 0, 1});
    const SweptPath::Near near = path_.near(p, 4 * reach_);
    const auto slope = [&](const Vec3& direction) {
      const double step = std::min(1e-5, 0.01 * tolerance_);
      return (near.distance(p + step * direction) - near.distance(p - step * direction)) / (2 * step);
    };
    EndError out;
    out.along = crossing(near, p, d, reach_);
    out.grazes = std::abs(slope(d)) < kSteepest || (out.along > tolerance_ && moves_with_the_ray(near, p, d));
    if (out.grazes) {
      const Vec3 normal{slope({1, 0, 0}), slope({0, 1, 0}), slope({0, 0, 1})};
      const double length = glm::length(normal);
      // Where distances from two sides meet, there is no normal; then measure along the ray.
      out.space = length > 0.1 ? std::min(out.along, crossing(near, p, normal / length, reach_)) : out.along;
    }
    return out;
  }

  /// Whether some ray one tolerance away has no exact end within two tolerances.
  bool moves_with_the_ray(const SweptPath::Near& near, const Vec3& p, const Vec3& d) const {
    for (const Vec3& side : {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, -1, 0}})
      if (crossing(near, p + tolerance_ * world(side), d, reach_) > 2 * tolerance_) return true;
    return false;
  }

  const Ray ray_;
  const SweptPath& path_;
  const double tolerance_, reach_;
  SweepErrors out_;
};

}  // namespace

SweepErrors sweep_errors(const Volume& volume, const Tool& tool, std::span<const Pose> poses, double tolerance,
                         int rays, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Ray> sample;
  for (const dexel::Grid& grid : volume.grids()) {
    const std::vector<Ray> some = chosen(grid, rays, random);
    sample.insert(sample.end(), some.begin(), some.end());
  }
  const SweptPath path(tool.profile(), poses);
  std::vector<SweepErrors> parts(sample.size());
  base::parallel_for(sample.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) parts[k] = Comparison(sample[k], path, tolerance).run();
  });
  SweepErrors out;
  for (const SweepErrors& part : parts) {
    out.ends.insert(out.ends.end(), part.ends.begin(), part.ends.end());
    out.points += part.points, out.wrong += part.wrong;
  }
  return out;
}

}  // namespace riffler::bench
