// Scallop: rows at equal distances from the border of the selected faces, inwards. Distances are measured on the drop
// surface, in units of the row distance that leaves the cusp, so that cusps are equal on slopes of any direction.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <queue>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/functions.hpp"
#include "geom/hypot.hpp"
#include "geom/math.hpp"
#include "plan/finish/field_rows.hpp"
#include "plan/finish/patterns.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::plan {

namespace {

constexpr double kFirstRow = 0.25;  // distance from the border in rows: the border is known to half a place
constexpr double kFinestRow = 1.0 / 128;
constexpr double kSteepestFace = 1.3;  // rad: on steeper faces neighbouring places are too far apart on the surface
constexpr double kLikeCurves = 0.05;   // tolerance for leaving out points of curves, as a share of the grid's spacing
constexpr double kMostScallopPlaces = 2e6;
constexpr const char* kSteeper = "scallop: faces steeper than 74° are left to waterline";

/// Distance of each place from the border of the set of places, by fast marching over triangles of neighbouring places
/// (Kimmel and Sethian, PNAS 95 (1998) 8431). The method needs only the lengths of the triangles' sides.
class Distances {
 public:
  Distances(const PatternScene& scene, const PlaceGrid& grid, const std::vector<SurfacePoint>& places,
            const PlaceSet& inside)
      : grid_(grid),
        places_(places),
        inside_(inside),
        steps_(scene.profile, kCuspShare * scene.options.cusp),
        ball_(scene.tool.kind() == "ball") {}

  Field run() {
    Field out(grid_.size(), 0);
    for (std::size_t k = 0; k < out.size(); ++k)
      if (inside_[k]) out[k] = kInfinity;
    for (std::size_t k = 0; k < out.size(); ++k)
      if (inside_[k] && at_border(k)) {
        out[k] = 0.5 * grid_.spacing / steps_(1, 0);
        front_.emplace(out[k], k);
      }
    PlaceSet done(grid_.size(), 0);
    for (std::size_t count = 0; !front_.empty(); ++count) {
      if (count % 4096 == 0) base::still_wanted();
      const auto [value, k] = front_.top();
      front_.pop();
      if (done[k]) continue;
      done[k] = 1;
      for (int i = 0; i < 8; ++i)
        if (const std::size_t n = neighbour(k, i); joined(k, n) && !done[n]) {
          const double d = update(n, out, done);
          if (d < out[n]) out[n] = d, front_.emplace(d, n);
        }
    }
    return out;
  }

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  /// The i-th neighbour of a place, counter-clockwise.
  std::size_t neighbour(std::size_t k, int i) const {
    static constexpr std::array<std::pair<int, int>, 8> kAround{
        {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};
    const auto columns = static_cast<std::size_t>(grid_.columns);
    const auto [x, y] = kAround[static_cast<std::size_t>(i % 8)];
    const int column = static_cast<int>(k % columns) + x, row = static_cast<int>(k / columns) + y;
    return column < 0 || row < 0 || column >= grid_.columns || row >= grid_.rows ? kNone : grid_.index(column, row);
  }
  /// Whether both places are inside and the surface between them has no step.
  bool joined(std::size_t a, std::size_t b) const {
    return b != kNone && inside_[a] && inside_[b] &&
           std::abs(places_[a].tip.z - places_[b].tip.z) <= 3 * base::tan(kSteepestFace) * grid_.spacing;
  }
  bool at_border(std::size_t k) const {
    for (int i = 0; i < 8; i += 2)
      if (!joined(k, neighbour(k, i))) return true;
    return false;
  }
  /// Length of the side between two places, in rows. For a ball on a curved surface the cusp grows with the distance of
  /// the tips times the distance of the contacts.
  double side(std::size_t a, std::size_t b) const {
    const Vec3 off = places_[a].tip - places_[b].tip;
    const double tips = glm::length(off), across = geom::hypot(off.x, off.y);
    const double contacts = ball_ ? glm::length(places_[a].landing.point - places_[b].landing.point) : tips;
    return std::sqrt(tips * std::clamp(contacts, 0.25 * tips, 4 * tips)) / steps_(across, off.z);
  }

  double update(std::size_t k, const Field& values, const PlaceSet& done) const {
    double least = kInfinity;
    for (int i = 0; i < 8; ++i) {
      const std::size_t a = neighbour(k, i), b = neighbour(k, i + 1);
      const bool with_a = joined(k, a) && done[a], with_b = joined(k, b) && done[b];
      if (with_a) least = std::min(least, values[a] + side(a, k));
      if (!with_a || !with_b || !joined(a, b)) continue;
      const double to_a = side(a, k), to_b = side(b, k), between = side(a, b);
      if (!(between > 0)) continue;
      const double x = (to_a * to_a - to_b * to_b + between * between) / (2 * between), y2 = to_a * to_a - x * x;
      const double rise = (values[b] - values[a]) / between;
      if (!(y2 > 0) || std::abs(rise) >= 1) continue;
      const double down = std::sqrt(1 - rise * rise), y = std::sqrt(y2), from = x - y * rise / down;
      if (from >= 0 && from <= between) least = std::min(least, values[a] + rise * x + down * y);
    }
    return least;
  }

  const PlaceGrid& grid_;
  const std::vector<SurfacePoint>& places_;
  const PlaceSet& inside_;
  RowSteps steps_;
  bool ball_;
  std::priority_queue<std::pair<double, std::size_t>, std::vector<std::pair<double, std::size_t>>, std::greater<>>
      front_;
};

/// The stretches of a curve near the places of a set, or the whole curve; a closed curve ends where it begins.
std::vector<std::vector<Vec2>> stretches(const Curve& curve, const PlaceGrid& grid, const PlaceSet* near) {
  std::vector<Vec2> points = simplified(curve, kLikeCurves * grid.spacing).points;
  if (near) points = curve.points;
  if (curve.closed && !points.empty()) points.push_back(points.front());
  std::vector<std::vector<Vec2>> out;
  bool on = false;
  for (const Vec2& p : points) {
    const bool here = !near || (*near)[grid.nearest(p)];
    if (here && !on) out.emplace_back();
    if (here) out.back().push_back(p);
    on = here;
  }
  return out;
}

class Scallop {
 public:
  Scallop(const PatternScene& scene, const Progress& progress)
      : scene_(scene), grid_(grid()), places_(grid_.size()), inside_(grid_.size()) {
    base::parallel_for(
        places_.size(), 256,
        [&](std::size_t begin, std::size_t end) {
          for (std::size_t k = begin; k < end; ++k) {
            if (k % 64 == 0) base::still_wanted();
            places_[k] = scene_.surface.at(grid_.place(k));
            inside_[k] = scene_.surface.passes(places_[k]) && scene_.surface.touched_slope(places_[k]) <= kSteepestFace;
          }
        },
        progress);
    values_ = Distances(scene_, grid_, places_, inside_).run();
  }

  PatternRows rows(const Progress& progress) const {
    RowField field{grid_, values_, {}, kFinestRow, 0, kSteepestFace, 0, nullptr, {}, {}};
    const double most = *std::max_element(values_.begin(), values_.end());
    for (double v = kFirstRow; v < most; v += 1) field.first.push_back(v);
    if (field.first.empty() && most > 0) field.first.push_back(0.5 * most);
    field.row = [this](double value, const PlaceSet* near, std::vector<BlockedPlace>& blocked) {
      std::vector<CutPiece> out;
      for (const Curve& curve : contours(grid_, values_, value))
        for (const std::vector<Vec2>& points : stretches(curve, grid_, near))
          for (std::vector<Vec3>& tips : scene_.surface.meant_pieces(scene_.surface.follow(points), blocked))
            out.push_back({value, std::move(tips)});
      return out;
    };
    field.between = [this](std::size_t a, std::size_t b, double value) -> std::optional<SurfacePoint> {
      const double share = (value - values_[a]) / (values_[b] - values_[a]);
      return scene_.surface.at(glm::mix(grid_.place(a), grid_.place(b), share));
    };
    PatternRows out = field_rows(scene_, field, progress);
    const double area = grid_.spacing * grid_.spacing;
    for (const SurfacePoint& p : places_)
      if (const char* reason = scene_.surface.blocked(p))
        add_blocked({{reason, p.tip, area / out.spacing}}, out.blocked);
    if (scene_.surface.steepest_meant() > kSteepestFace) add_blocked({{kSteeper, steep_place(), 0}}, out.blocked);
    if (out.pieces.empty() && scene_.surface.steepest_meant() > kSteepestFace)
      out.reason = "scallop: the tool touches no face up to 74° steep that slopes and region mean";
    return out;
  }

 private:
  PlaceGrid grid() const {
    PlaceGrid out;
    const double step = scene_.profile.spacing(kCuspShare * scene_.options.cusp);
    out.spacing = std::min(step / 3, scene_.profile.radius() / 6);
    const double around = scene_.profile.radius() + scene_.options.allowance + 2 * out.spacing;
    out.lower = Vec2(scene_.part.lower) - around;
    const Vec2 size = (Vec2(scene_.part.upper) + around - out.lower) / out.spacing;
    if (!(size.x * size.y <= kMostScallopPlaces))
      throw std::invalid_argument("cusp: so small for this tool and part that scallop needs " +
                                  std::to_string(std::lround(size.x * size.y / 1e6)) +
                                  " million places; take a larger one, a larger tool, or parallel");
    out.columns = static_cast<int>(std::ceil(size.x)) + 1, out.rows = static_cast<int>(std::ceil(size.y)) + 1;
    return out;
  }
  /// A place next to a step of the surface.
  Vec3 steep_place() const {
    for (std::size_t k = 0; k + 1 < places_.size(); ++k)
      if (inside_[k] != inside_[k + 1]) return places_[inside_[k] ? k : k + 1].tip;
    return scene_.part.lower;
  }

  const PatternScene& scene_;
  PlaceGrid grid_;
  std::vector<SurfacePoint> places_;
  PlaceSet inside_;
  Field values_;
};

}  // namespace

PatternRows scallop_rows(const PatternScene& scene, const Progress& progress) {
  return Scallop(scene, base::part(progress, 0, 0.3)).rows(base::part(progress, 0.3, 1));
}

}  // namespace riffler::plan
