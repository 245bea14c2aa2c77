#include "riffler/plan/engrave.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "geom/directions.hpp"
#include "mesh/closest.hpp"
#include "mesh/smooth_normals.hpp"
#include "riffler/base/check.hpp"
#include "riffler/base/parallel.hpp"
#include "riffler/mesh/orient.hpp"
#include "riffler/plan/cc_frame.hpp"
#include "riffler/plan/contact_location.hpp"

namespace riffler::plan {

namespace {

constexpr double kNothing = 1e-3;  // in tolerances: shorter pieces of curve are not divided
constexpr std::size_t kMaxPoints = 10'000'000, kPointsAReport = 1024;
constexpr int kBridges = 6;  // levels of bisection: up to 64 points over one edge

struct OnPart {
  Vec3 point, normal;
};

[[noreturn]] void bad(const std::string& what) {
  throw std::invalid_argument(what);
}

void check(const EngraveOptions& o) {
  base::require_tolerance(o.tolerance);
  base::require_positive(o.turn, "turn", base::kPositiveAndFinite);
  base::require_positive(o.reach, "reach", base::kPositiveAndFinite);
  if (!(o.crease >= 0 && o.crease <= 3.1416)) bad("crease must lie between 0 and π");
  if (!std::isfinite(o.depth)) bad("depth is not finite");
  if (!(std::abs(o.inclination) < 1.57) || !(std::abs(o.tilt) < 1.57))
    bad("inclination and tilt must lie within a right angle of the normal");
}

/// The part's surface, onto which curves are projected.
class Sheet {
 public:
  Sheet(const Mesh& part, const EngraveOptions& options)
      : closest_(part), normals_(part, options.crease), options_(options) {}

  OnPart under(const Vec3& p) const {
    const mesh::Closest::Hit hit = closest_(p);
    return {hit.point, normals_.at(hit.triangle, hit.point)};
  }
  double distance(const Vec3& p) const { return closest_(p).distance; }

  /// The curve's points on the part, and as many between them as the options require.
  std::vector<OnPart> lay(const std::vector<Vec3>& curve) const {
    std::vector<OnPart> out{under(curve[0])};
    for (std::size_t k = 1; k < curve.size(); ++k)
      if (curve[k] != curve[k - 1]) divide(curve[k - 1], under(curve[k - 1]), curve[k], under(curve[k]), out);
    return out;
  }

 private:
  /// Appends the points after `from` up to `to`, which lie on the part under a and b.
  void divide(const Vec3& a, const OnPart& from, const Vec3& b, const OnPart& to, std::vector<OnPart>& out) const {
    if (glm::length(b - a) < kNothing * options_.tolerance) return bridge(from, to, 0, out);
    const Vec3 middle = 0.5 * (a + b);
    const OnPart between = under(middle);
    if (needs(from, between, to)) {
      divide(a, from, middle, between, out);
      divide(middle, between, b, to, out);
    } else {
      append(to, out);
    }
  }

  /// Where the nearest point jumps from one face to another, fills in the edge between them with the points nearest to
  /// the midpoint as seen from far outside or, for a concave edge, from deep inside.
  void bridge(const OnPart& from, const OnPart& to, int depth, std::vector<OnPart>& out) const {
    const Vec3 chord = to.point - from.point;
    const Vec3 outwards =
        glm::dot(chord, to.normal - from.normal) >= 0 ? from.normal + to.normal : -(from.normal + to.normal);
    const OnPart between = under(from.point + 0.5 * chord + glm::length(chord) * outwards);
    if (depth < kBridges && away(from, between, to) > options_.tolerance) {
      bridge(from, between, depth + 1, out);
      bridge(between, to, depth + 1, out);
    } else {
      append(to, out);
    }
  }

  static void append(const OnPart& to, std::vector<OnPart>& out) {
    if (out.size() >= kMaxPoints)
      bad("a curve of more than ten million points: take a larger tolerance or turn, or check the units");
    if (out.size() % kPointsAReport == 0) base::still_wanted();
    if (to.point != out.back().point || to.normal != out.back().normal) out.push_back(to);
  }

  /// Distance of `between` from the chord.
  static double away(const OnPart& from, const OnPart& between, const OnPart& to) {
    const Vec3 chord = to.point - from.point, off = between.point - from.point;
    const double length2 = glm::dot(chord, chord), share = length2 > 0 ? glm::dot(off, chord) / length2 : 0;
    return glm::length(off - std::clamp(share, 0.0, 1.0) * chord);
  }

  bool needs(const OnPart& from, const OnPart& between, const OnPart& to) const {
    if (away(from, between, to) > options_.tolerance) return true;
    // Division cannot help at a sharp edge: below the size of the tolerance the axis turns at once.
    const double longest = std::max(glm::length(to.point - from.point), glm::length(between.point - from.point));
    if (longest <= options_.tolerance) return false;
    return geom::angle_between(from.normal, to.normal) > options_.turn ||
           geom::angle_between(from.normal, between.normal) > options_.turn;
  }

  mesh::Closest closest_;
  mesh::SmoothNormals normals_;
  const EngraveOptions& options_;
};

void check(const std::vector<Vec3>& curve, const std::string& name, const Sheet& sheet, double reach) {
  if (curve.size() < 2) bad(name + " has fewer than two points");
  bool moves = false;
  for (std::size_t k = 0; k < curve.size(); ++k) {
    const std::string point = name + ", point " + std::to_string(k);
    if (!geom::finite(curve[k])) bad(point + " is not finite");
    if (const double d = sheet.distance(curve[k]); d > reach)
      bad(point + " is " + std::to_string(d) + " mm from the part, more than reach");
    moves = moves || curve[k] != curve[0];
  }
  if (!moves) bad(name + " has all its points at one place");
}

Vec3 feed_at(const std::vector<OnPart>& way, std::size_t k) {
  return way[std::min(k + 1, way.size() - 1)].point - way[k > 0 ? k - 1 : 0].point;
}

}  // namespace

std::vector<Engraved> engrave(const Mesh& part, const std::vector<std::vector<Vec3>>& curves, const Tool& tool,
                              const EngraveOptions& options, const Progress& progress) {
  check(options);
  validate(part);
  if (part.empty()) bad("a part without triangles");
  std::optional<Mesh> storage;
  const Sheet sheet(as_solid(part, storage, mesh::Hollow::Kept), options);
  for (std::size_t k = 0; k < curves.size(); ++k) check(curves[k], "curve " + std::to_string(k), sheet, options.reach);
  const CutterSupport cutter(tool);
  std::vector<Engraved> out(curves.size());
  base::parallel_for(
      curves.size(), 1,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end; ++c) {
          const std::vector<OnPart> way = sheet.lay(curves[c]);
          for (std::size_t k = 0; k < way.size(); ++k) {
            const auto& [point, normal] = way[k];
            const Vec3 feed = feed_at(way, k);
            const Vec3 axis = axis_of(cc_frame(feed, normal), {options.inclination, options.tilt});
            out[c].contacts.push_back(point), out[c].normals.push_back(normal);
            out[c].poses.push_back(location_of_contact(cutter, point - options.depth * normal, normal, axis, feed));
          }
        }
      },
      progress);
  return out;
}

}  // namespace riffler::plan
