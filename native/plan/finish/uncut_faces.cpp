#include "plan/finish/uncut_faces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "base/functions.hpp"
#include "geom/hypot.hpp"
#include "geom/math.hpp"
#include "plan/finish/row_index.hpp"
#include "riffler/base/parallel.hpp"
#include "riffler/plan/contact_location.hpp"

namespace riffler::plan {

namespace {

constexpr double kSteepest = 1.3;       // rad; steeper faces need rows at levels
constexpr double kStep = 0.5;           // distance of samples, in distances of rows
constexpr double kSmallFace = 0.25;     // length of triangles with a single sample, in distances of samples
constexpr double kInsetOfSides = 0.05;  // distance of samples from a side, about, in distances of rows
constexpr double kPiece = 1.0;          // length of a piece on either side of a sample, in distances of rows
constexpr double kOverOthers = 0.2;     // length of a piece over faces that are not selected, in distances of rows
constexpr double kMostFaceSamples = 4e6;
constexpr double kTolerance = 0.25;  // share of the tolerance that is allowed at samples
constexpr double kLevelFace = 1e-3;  // rad from level, within which a level end may touch with any place of its rim
constexpr int kSides = 8;

/// A sample that the rows have left, and a tip that cuts it.
struct Spot {
  Vec3 point{0};  ///< the highest that material may reach
  Vec3 tip{0};
  Vec2 side{0};  ///< of the face's normal, seen along the axis
};

class Uncut {
 public:
  Uncut(const PatternScene& scene, const PatternRows& rows)
      : scene_(scene),
        cutter_(scene.tool),
        spacing_(rows.spacing),
        high_(scene.options.allowance + scene.options.cusp + kTolerance * scene.options.tolerance),
        least_slope_(rows.least_slope),
        steps_(scene.profile, scene.options.cusp),
        near_(scene.part, near_window(scene, spacing_)),
        wide_(scene.part, scene.profile.radius()) {
    for (const CutPiece& piece : rows.pieces) add(piece.tips);
    const double area = 2 * (scene.part.upper.x - scene.part.lower.x) * (scene.part.upper.y - scene.part.lower.y);
    finest_ = std::sqrt(area / kMostFaceSamples);
    hidden_ = undersides();
  }

  void run(PatternRows& rows, const Progress& progress) {
    const std::vector<Spot> spots = find(base::part(progress, 0, 0.8));
    double rank = 0;
    for (const CutPiece& piece : rows.pieces) rank = std::max(rank, piece.rank);
    for (std::size_t k = 0; k < spots.size(); ++k) {
      base::report(progress, 0.8 + 0.2 * static_cast<double>(k) / static_cast<double>(spots.size()));
      if (is_cut(spots[k], true)) continue;
      const std::vector<Vec3> tips = piece(spots[k].tip, rows.descending ? along_level(spots[k]) : direction(spots, k));
      add(tips);
      rows.pieces.push_back({rows.descending ? -spots[k].tip.z : rank + 1, tips});
      ++rows.added;
    }
  }

 private:
  /// Distance (mm) within which the rows are that most likely cut a sample.
  static double near_window(const PatternScene& scene, double spacing) {
    const double least = scene.profile.radius() / 8;
    return CutterSupport(scene.tool).ball_radius() > 0 ? std::max(least, 0.55 * spacing) : least;
  }

  /// Which triangles look downwards, if most of the part's triangles are oriented outwards.
  std::vector<char> undersides() const {
    const Mesh& mesh = scene_.surface.mesh();
    std::vector<char> out(scene_.surface.part_triangles());
    double volume = 0;
    for (std::size_t k = 0; k < out.size(); ++k) {
      const Vec3i t = mesh.triangles[k];
      const auto at = [&](int i) { return mesh.vertices[static_cast<std::size_t>(i)]; };
      const Vec3 a = at(t.x), b = at(t.y), c = at(t.z);
      const double area = glm::cross(b - a, c - a).z;
      out[k] = area < 0, volume += area * ((a.z + b.z + c.z) / 3 - scene_.part.lower.z);
    }
    if (!(volume > 0)) out.assign(out.size(), 0);
    return out;
  }

  /// A piece of a row through a tip: as far as the cutter touches selected faces, and a little over others.
  std::vector<Vec3> piece(const Vec3& tip, const Vec2& way) const {
    std::vector<Vec3> out{tip};
    for (const double sign : {1.0, -1.0}) {
      const auto at = [&](double share) { return Vec2(tip) + sign * share * spacing_ * way; };
      for (const SurfacePoint& p : scene_.surface.follow({Vec2(tip), at(kOverOthers), at(kPiece)})) {
        const double off = geom::hypot(p.tip.x - tip.x, p.tip.y - tip.y);
        if (p.gap || !p.landing.touches || scene_.surface.blocked(p) || std::abs(p.tip.z - tip.z) > spacing_) break;
        if (off > 1.001 * kOverOthers * spacing_ && !scene_.surface.passes(p)) break;
        if (p.tip != out.back()) out.push_back(p.tip);
      }
      std::reverse(out.begin(), out.end());
    }
    if (out.size() == 1) out.insert(out.begin(), tip + Vec3(0, 0, scene_.surface.tolerance()));  // between two steps
    return out;
  }

  void add(const std::vector<Vec3>& tips) { near_.add(tips), wide_.add(tips); }

  std::vector<Spot> find(const Progress& progress) const {
    const std::size_t n = scene_.surface.part_triangles();
    std::vector<std::vector<Spot>> found(n);
    base::parallel_for(
        n, 64,
        [&](std::size_t begin, std::size_t end) {
          for (std::size_t k = begin; k < end; ++k) {
            if (k % 64 == 0) base::still_wanted();
            look_at(static_cast<int>(k), found[k]);
          }
        },
        progress);
    std::vector<Spot> out;
    for (const std::vector<Spot>& some : found) out.insert(out.end(), some.begin(), some.end());
    return out;
  }

  /// Samples of a triangle in rows along its longest side, and next to its sides: strips along borders are narrow.
  void look_at(int triangle, std::vector<Spot>& out) const {
    const FinishSurface& surface = scene_.surface;
    const double slope = surface.face_slope(triangle);
    if (hidden_[static_cast<std::size_t>(triangle)] || slope < least_slope_ || slope > kSteepest ||
        !surface.meant_slope(slope))
      return;
    const Vec3i t = surface.mesh().triangles[static_cast<std::size_t>(triangle)];
    std::array<Vec3, 3> p{surface.mesh().vertices[static_cast<std::size_t>(t.x)],
                          surface.mesh().vertices[static_cast<std::size_t>(t.y)],
                          surface.mesh().vertices[static_cast<std::size_t>(t.z)]};
    const auto side = [&](std::size_t k) { return glm::length(p[(k + 1) % 3] - p[k]); };
    std::size_t longest = 0;
    for (const std::size_t k : {std::size_t{1}, std::size_t{2}}) longest = side(k) > side(longest) ? k : longest;
    std::rotate(p.begin(), p.begin() + static_cast<std::ptrdiff_t>(longest), p.end());
    const double length = glm::length(p[1] - p[0]);
    if (!(length > 0)) return;
    const double height = glm::length(glm::cross(p[1] - p[0], p[2] - p[0])) / length;
    const double step = std::max(finest_, kStep * steps_(base::cos(slope), base::sin(slope)));
    const bool small = length < kSmallFace * step;
    const int rows = std::max(small ? 1 : 2, static_cast<int>(std::ceil(height / step)));
    const auto look = [&](const Vec3& contact) {
      if (!surface.wanted_face(triangle, contact, slope)) return;
      if (const std::optional<Spot> spot = left_at(contact, surface.face_normal(triangle))) out.push_back(*spot);
    };
    for (int row = 0; row < rows; ++row) {
      const double up = (row + 0.5) / rows;
      const int count = std::max(1, static_cast<int>(std::ceil((1 - up) * length / step)));
      for (int k = 0; k < count; ++k) {
        if (k % 256 == 255) base::still_wanted();
        const double along = (1 - up) * (k + 0.5) / count;
        look(p[0] + along * (p[1] - p[0]) + up * (p[2] - p[0]));
      }
    }
    if (small) return;
    const Vec3 middle = (p[0] + p[1] + p[2]) / 3.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const int count = std::max(1, static_cast<int>(std::ceil(side(k) / step)));
      for (int i = 0; i < count; ++i) {
        if (i % 256 == 255) base::still_wanted();
        const Vec3 on_side = glm::mix(p[k], p[(k + 1) % 3], (i + 0.5) / count);
        look(glm::mix(on_side, middle, std::min(0.3, kInsetOfSides * spacing_ / height)));
      }
    }
  }

  /// The spot of a contact, if the rows leave it and the cutter reaches it.
  std::optional<Spot> left_at(const Vec3& contact, const Vec3& normal) const {
    const bool level = normal.z > base::cos(kLevelFace) && !(cutter_.ball_radius() > 0);
    const Vec3 point = contact + high_ * normal;
    for (int k = 0; k < (level ? kSides : 1); ++k) {
      const double turn = geom::kTwoPi * k / kSides;
      const Vec3 feed(base::cos(turn), base::sin(turn), 0);
      const Vec3 on_face = contact + scene_.options.allowance * normal;
      const Vec3 tip = location_of_contact(cutter_, on_face, level ? Vec3(0, 0, 1) : normal, {0, 0, 1}, feed).tip;
      if (k == 0 && is_cut({point, tip, {}}, level)) return {};
      const SurfacePoint p = scene_.surface.at(Vec2(tip));
      if (!p.landing.touches || scene_.surface.blocked(p) || !removes(p.tip, point)) continue;
      const Spot spot{point, p.tip, Vec2(normal)};
      if (is_cut(spot, true)) return {};
      return spot;
    }
    return {};
  }

  bool removes(const Vec3& tip, const Vec3& point) const {
    const double rho = geom::hypot(point.x - tip.x, point.y - tip.y);
    return rho <= scene_.profile.radius() && tip.z + scene_.profile.height(rho) <= point.z;
  }

  /// Whether a move removes a point: at the places nearest to the spot's tip and to the point, and at its ends.
  bool removes(const Vec3& a, const Vec3& b, const Vec3& tip, const Vec3& point) const {
    if (std::min(a.z, b.z) > point.z) return false;
    const Vec2 way = Vec2(b) - Vec2(a);
    const double square = glm::dot(way, way);
    for (const Vec3* near : {&tip, &point}) {
      const double s = square > 0 ? std::clamp(glm::dot(Vec2(*near) - Vec2(a), way) / square, 0.0, 1.0) : 0.0;
      if (removes(glm::mix(a, b, s), point)) return true;
    }
    return removes(a, point) || removes(b, point);
  }

  /// Whether the rows next to a spot remove its point. `all`: all rows that reach it.
  bool is_cut(const Spot& spot, bool all) const {
    const auto move = [&](const Vec3& a, const Vec3& b) { return removes(a, b, spot.tip, spot.point); };
    return near_.any(spot.tip, move) || (all && wide_.any(spot.point, move));
  }

  /// The level direction on a spot's face that has the material on the side that the option `climb` asks for.
  Vec2 along_level(const Spot& spot) const {
    const double length = geom::hypot(spot.side.x, spot.side.y);
    if (!(length > 0)) return {1, 0};
    return (scene_.options.climb ? 1 : -1) / length * Vec2(spot.side.y, -spot.side.x);
  }
  /// The direction in which the spots near one lie.
  Vec2 direction(const std::vector<Spot>& spots, std::size_t k) const {
    double xx = 0, xy = 0, yy = 0;
    const std::size_t first = k > kNeighbours ? k - kNeighbours : 0, last = std::min(k + kNeighbours, spots.size() - 1);
    for (std::size_t i = first; i <= last; ++i) {
      const Vec2 off = Vec2(spots[i].tip) - Vec2(spots[k].tip);
      if (geom::hypot(off.x, off.y) < 2 * spacing_) xx += off.x * off.x, xy += off.x * off.y, yy += off.y * off.y;
    }
    const double turn = 0.5 * base::atan2(2 * xy, xx - yy);
    return {base::cos(turn), base::sin(turn)};
  }

  static constexpr std::size_t kNeighbours = 100;

  const PatternScene& scene_;
  CutterSupport cutter_;
  double spacing_, high_, least_slope_, finest_ = 0;
  RowSteps steps_;
  std::vector<char> hidden_;
  RowIndex near_, wide_;
};

}  // namespace

void cut_uncut_faces(const PatternScene& scene, PatternRows& rows, const Progress& progress) {
  if (!(rows.spacing > 0)) return;
  Uncut(scene, rows).run(rows, progress);
}

}  // namespace riffler::plan
