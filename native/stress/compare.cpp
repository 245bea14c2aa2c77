#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include "reference/swept_distance.hpp"
#include "stress/checks.hpp"

namespace riffler::stress {

namespace {

constexpr double kGrazing = 2.23606797749979;  // √5: where the distance along the ray is more than this times that
                                               // in space, an end is measured in space

struct RayName {
  std::size_t grid;
  int i, j;
};

bool inside(std::span<const dexel::Span> ray, double s) {
  return std::any_of(ray.begin(), ray.end(), [s](const dexel::Span& x) { return s >= x.near && s <= x.far; });
}

bool is_end(std::span<const dexel::Span> ray, double s) {
  return std::any_of(ray.begin(), ray.end(), [s](const dexel::Span& x) { return s == x.near || s == x.far; });
}

/// Up to `count` changed rays, chosen evenly, and a few others.
std::vector<RayName> choose_rays(Random& random, const Volume& before, const Volume& after, int count) {
  std::vector<RayName> changed, chosen;
  for (std::size_t g = 0; g < after.grids().size(); ++g) {
    const dexel::Grid &a = before.grids()[g], &b = after.grids()[g];
    for (int i = 0; i < b.nu(); ++i)
      for (int j = 0; j < b.nv(); ++j)
        if (!std::ranges::equal(a.ray(i, j), b.ray(i, j))) changed.push_back({g, i, j});
  }
  for (int k = 0; k < count && !changed.empty(); ++k) {
    const std::size_t at = random.bits() % changed.size();
    chosen.push_back(changed[at]);
    changed[at] = changed.back();
    changed.pop_back();
  }
  for (int k = 0; k < 1 + count / 4; ++k) {
    const std::size_t g = random.bits() % after.grids().size();
    const dexel::Grid& grid = after.grids()[g];
    const int i = random.below(grid.nu());
    chosen.push_back({g, i, random.below(grid.nv())});
  }
  return chosen;
}

/// Compares one ray.
class RayComparison {
 public:
  RayComparison(const reference::SweptDistance& swept, const Allowed& allowed, const dexel::Grid& before,
                const dexel::Grid& after, const RayName& ray, double radius, Comparison& out)
      : swept_(swept),
        rules_(allowed),
        allowed_(allowed.error),
        grid_(after),
        before_(before.ray(ray.i, ray.j)),
        after_(after.ray(ray.i, ray.j)),
        normals_(after.ray_normals(ray.i, ray.j)),
        radius_(radius),
        ray_(ray),
        out_(out) {}

  void run(Random& random) {
    for (std::size_t k = 0; k < after_.size(); ++k)
      for (const bool near : {true, false}) {
        const double end = near ? after_[k].near : after_[k].far;
        if (is_end(before_, end)) continue;
        compare_end(end, near);
        if (!normals_.empty()) compare_normal(end, (near ? normals_[k].near : normals_[k].far).unpack());
      }
    for (const double s : places(random)) compare_point(s);
  }

 private:
  /// Signed distance, as accurate as the comparison with `allowed_` needs.
  double distance(double s) const {
    const Vec3 p = to_world(grid_.axis(), {grid_.u(ray_.i), grid_.v(ray_.j), s});
    return swept_.bracket(p, allowed_ / 50, 4 * allowed_).upper;
  }

  /// Places to check: middles of spans and gaps, places near ends, and random ones.
  std::vector<double> places(Random& random) const {
    const double lower = grid_.box().lower.z, upper = grid_.box().upper.z;
    std::vector<double> out;
    double last = lower;
    for (const dexel::Span& s : after_) {
      out.push_back((last + s.near) / 2);
      out.push_back((s.near + s.far) / 2);
      for (const double d : {-3.0, 3.0}) out.push_back(s.near + d * allowed_), out.push_back(s.far + d * allowed_);
      last = s.far;
    }
    out.push_back((last + upper) / 2);
    for (int k = 0; k < 3; ++k) out.push_back(random.uniform(lower, upper));
    std::erase_if(out, [&](double s) { return !(s > lower && s < upper); });
    return out;
  }

  void compare_end(double end, bool near) {
    ++out_.ends;
    const double off = distance(end);
    double error = std::abs(off);
    if (rules_.along_rays && error <= allowed_) error = along(end, near, off);
    out_.worst = std::max(out_.worst, error / allowed_);
    if (error > allowed_) fail(off < 0 ? "too little cut, the end" : "cut too deep, the end", end, error);
  }

  struct NormalError {
    double error, allowed;  // rad
  };

  /// The error of a normal, or none where the surface is not smooth or another part of it is near. A point of the
  /// material at a small distance from the end, against the normal, has the end as the nearest point of the swept
  /// surface, so the distance grows against the normal there, by 1 mm per mm. The surface counts as smooth if the
  /// gradient's length is 1 within 1e-5 and central differences of two sizes agree within 2e-5: where two parts of the
  /// surface are about equally near, they do not. Outside an edge the distance is smooth, and any normal between those
  /// of both sides passes.
  std::optional<NormalError> normal_error(double end, const Vec3& normal, double step) const {
    const Vec3 at = to_world(grid_.axis(), {grid_.u(ray_.i), grid_.v(ray_.j), end}), p = at - 3 * step * normal;
    const Vec3 a = gradient(p, step), b = gradient(p, step / 2);
    if (std::abs(glm::length(a) - 1) > 1e-5 || glm::length(a - b) > 2e-5) return {};
    const double error = glm::length(glm::normalize(b) + normal);
    // On a ridge of the material, each side's normal leads to where the other side is nearer.
    if (error > rules_.normal(radius_) &&
        swept_.bracket(at + 3 * step * glm::normalize(b), 1e-5 * step).upper < 2.997 * step - allowed_)
      return {};
    const bool curved = rules_.hollow > 0 && error > rules_.normal(radius_);
    return NormalError{error, rules_.normal(curved ? 1 / curvature(p, step) : radius_)};
  }

  void compare_normal(double end, const Vec3& normal) {
    const double finest = std::max(rules_.hollow, 100 * (allowed_ - rules_.hollow));  // the rest of it is rounding
    std::optional<NormalError> found;
    for (const double size : {1e-3, 1e-4, 1e-5}) {  // a crease is not near at every size
      const double step = std::max(size * radius_, rules_.any_normal ? allowed_ : 0);
      if (step < finest && !rules_.any_normal && found) break;
      found = normal_error(end, normal, step);
      if (!found || found->error <= found->allowed || rules_.any_normal) break;
    }
    if (!found) return;
    ++out_.normals;
    double& worst = rules_.any_normal ? out_.turned : out_.worst_normal;
    worst = std::max(worst, found->error);
    if (rules_.any_normal || found->error <= found->allowed || !out_.problem.empty()) return;
    std::ostringstream text;
    text.precision(17);
    text << "the normal at the end " << end << name_of_ray() << " is " << found->error << " rad off; allowed are "
         << found->allowed;
    out_.problem = text.str();
  }

  /// Largest curvature of the surface (its rank is 1 where a tool moves straight), from the change of the gradient.
  double curvature(const Vec3& p, double step) const {
    double square = 0;
    for (int k = 0; k < 3; ++k) {
      Vec3 way(0);
      way[k] = step;
      const Vec3 change = (gradient(p + way, step) - gradient(p - way, step)) / (2 * step);
      square += glm::dot(change, change);
    }
    return std::sqrt(square);
  }

  Vec3 gradient(const Vec3& p, double step) const {
    Vec3 g;
    for (int k = 0; k < 3; ++k) {
      Vec3 way(0);
      way[k] = step;
      const auto at = [&](const Vec3& q) { return swept_.bracket(q, 1e-7 * step).upper; };
      g[k] = (at(p + way) - at(p - way)) / (2 * step);
    }
    return g;
  }

  /// Distance along the ray from an end, which is `off` mm outside the swept volume, to the surface: into the material
  /// if too little was cut, else away from it. If the ray grazes, the distance in space.
  double along(double end, bool near, double off) const {
    const double least = std::abs(off), furthest = kGrazing * least;
    if (furthest < allowed_ / 20) return least;
    const double onwards = (off <= 0) == near ? 1 : -1;
    for (double reach = least; reach < furthest; reach *= 1.1)
      if ((distance(end + onwards * reach) <= 0) != (off <= 0)) return reach;
    return (distance(end + onwards * furthest) <= 0) != (off <= 0) ? furthest : least;
  }

  void compare_point(double s) {
    const double off = distance(s);
    ++out_.points;
    if (std::abs(off) <= allowed_) return;
    const bool solid = inside(after_, s);
    if (off < 0 && solid) fail("too little cut, the point", s, off);
    if (off > 0 && solid != inside(before_, s)) fail("cut too much, the point", s, off);
  }

  void fail(const char* what, double s, double off) {
    if (!out_.problem.empty()) return;
    std::ostringstream text;
    text.precision(17);
    text << what << " " << s << name_of_ray() << " is " << off << " mm from the swept surface; allowed are "
         << allowed_;
    out_.problem = text.str();
  }

  std::string name_of_ray() const {
    return " of ray " + std::to_string(ray_.i) + ", " + std::to_string(ray_.j) + " of direction " +
           "xyz"[static_cast<int>(grid_.axis())];
  }

  const reference::SweptDistance& swept_;
  const Allowed& rules_;
  double allowed_;
  const dexel::Grid& grid_;
  std::span<const dexel::Span> before_, after_;
  std::span<const dexel::SpanNormals> normals_;
  double radius_;
  RayName ray_;
  Comparison& out_;
};

}  // namespace

Comparison compare_with_reference(Random& random, const Stage& stage, const Move& move, const Volume& before,
                                  const Volume& after, int rays) {
  Comparison out;
  const reference::SweptDistance swept(stage.tool.profile(), Motion(move.from, move.to));
  const Allowed allowed = allowed_error(stage, move);
  for (const RayName& ray : choose_rays(random, before, after, rays))
    RayComparison(swept, allowed, before.grids()[ray.grid], after.grids()[ray.grid], ray,
                  stage.tool.profile().max_radius(), out)
        .run(random);
  return out;
}

}  // namespace riffler::stress
