#include "plan/finish/level_curves.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "geom/hypot.hpp"
#include "geom/math.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::plan {

namespace {

constexpr double kPrecision = 1.0 / 32;  // error of points across a curve, as a share of the tolerance
constexpr double kOff = 0.25;  // largest distance of a move's middle from the curve, as a share of the tolerance
constexpr double kClose = 4;   // largest distance from the height of the face touched, in tolerances
constexpr double kMostPlaces = 4e6;
constexpr double kWallSlack = 0.0025;  // of the radius: how much farther a face 4° from upright is at its half height
constexpr int kSteps = 64;

double length(const Vec2& p) {
  return geom::hypot(p.x, p.y);
}

PlaceGrid grid_over(const PatternScene& scene, double spacing) {
  PlaceGrid grid;
  grid.spacing = spacing;
  const double around = scene.profile.radius() + scene.options.allowance + 3 * spacing;
  grid.lower = Vec2(scene.part.lower) - around;
  const Vec2 size = Vec2(scene.part.upper) - Vec2(scene.part.lower) + 2 * around;
  const double places = (size.x / spacing + 2) * (size.y / spacing + 2);
  if (!(places <= kMostPlaces))
    throw std::invalid_argument("cusp: so small for this tool and part that " + scene.options.pattern + " needs " +
                                std::to_string(std::lround(places / 1e6)) + " million places; take a larger one");
  grid.columns = static_cast<int>(std::ceil(size.x / spacing)) + 1;
  grid.rows = static_cast<int>(std::ceil(size.y / spacing)) + 1;
  return grid;
}

void add_blocked_move(const char* reason, const Vec3& tip, double mm, std::vector<BlockedPlace>& blocked) {
  for (BlockedPlace& one : blocked)
    if (one.reason == reason) {
      one.length += mm;
      return;
    }
  blocked.push_back({reason, tip, mm});
}

/// Runs of consecutive kept elements, as first index and count. In a ring the last run may continue at the beginning.
std::vector<std::pair<std::size_t, std::size_t>> runs(const std::vector<char>& keep, bool ring) {
  std::vector<std::pair<std::size_t, std::size_t>> out;
  const std::size_t n = keep.size();
  std::size_t first = 0;
  if (ring)
    while (first < n && keep[first]) ++first;
  if (first == n) return {{0, n}};
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t k = (first + i) % n;
    if (!keep[k]) continue;
    if (i > 0 && keep[(k + n - 1) % n] && !out.empty())
      ++out.back().second;
    else
      out.emplace_back(k, 1);
  }
  return out;
}

}  // namespace

LevelCurves::LevelCurves(const PatternScene& scene, double spacing, double least_slope, const Progress& progress)
    : scene_(scene),
      tolerance_(scene.surface.tolerance()),
      least_slope_(least_slope),
      low_(scene.part.lower.z - 1),
      reach_(scene.profile.radius() + scene.options.allowance + 0.5 * tolerance_),
      middle_(scene.profile.height(scene.profile.radius())),
      outer_(scene.surface.mesh(), scene.tool, {0, 0, 1}, scene.options.allowance + 0.5 * tolerance_),
      walls_(scene.surface.mesh()),
      grid_(grid_over(scene, spacing)),
      heights_(grid_.size()) {
  base::parallel_for(
      heights_.size(), 1024,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) heights_[k] = height(grid_.place(k));
      },
      progress);
}

double LevelCurves::height(const Vec2& p) const {
  const DropCutter::Landing found = outer_(Vec3(p, 0));
  scene_.surface.count_drop();
  return found.touches ? std::max(found.height, low_) : low_;
}

Vec2 LevelCurves::border(Vec2 low, Vec2 high, double z) const {
  const double precise = kPrecision * tolerance_;
  double at_low = height(low), at_high = height(high);
  bool last_low = false;
  for (int k = 0; k < kSteps; ++k) {
    const double gap = length(high - low);
    if (gap <= precise) break;
    double share = 0.5;
    if (k % 3 != 2 && at_high > at_low) {
      // A little beyond the point where the line between both ends meets z, so that the other end moves as well.
      share = (z - at_low) / (at_high - at_low) + (last_low ? 0.4 : -0.4) * precise / gap;
      share = std::clamp(share, 0.4 * precise / gap, 1 - 0.4 * precise / gap);
    }
    const Vec2 p = glm::mix(low, high, share);
    const double h = height(p);
    last_low = h <= z;
    if (last_low)
      low = p, at_low = h;
    else
      high = p, at_high = h;
  }
  return low;
}

bool LevelCurves::sees_below(const Vec2& p, double z) const {
  const Vec2 at = (p - grid_.lower) / grid_.spacing;
  const int column = std::clamp(static_cast<int>(at.x), 0, grid_.columns - 2),
            row = std::clamp(static_cast<int>(at.y), 0, grid_.rows - 2);
  for (int k = 0; k < 4; ++k)
    if (heights_[grid_.index(column + (k & 1), row + k / 2)] <= z) return true;
  return false;
}

/// A point of the curve between two of its points; none if the straight line between them is near enough.
std::optional<Vec2> LevelCurves::between(const Vec2& a, const Vec2& b, double z) const {
  const double far = length(b - a), off = kOff * tolerance_;
  const Vec2 right = Vec2(b.y - a.y, a.x - b.x) / far, m = 0.5 * (a + b);
  const bool inside = height(m) > z;
  const double side = inside ? -1 : 1;
  Vec2 before = m;
  for (double d = off; d <= far; d *= 2) {
    const Vec2 p = m + side * d * right;
    if ((height(p) > z) != inside) {
      if (d <= off && scene_.surface.above(Vec3(a, z), Vec3(b, z)) <= 0) return {};
      return inside ? border(p, before, z) : border(before, p, z);
    }
    before = p;
  }
  // The curve is out of reach: the line leads through the air, or through the part.
  if (scene_.surface.above(Vec3(a, z), Vec3(b, z)) <= 0 || inside) return {};
  return m;
}

/// Adds the points after `a` up to `b`.
void LevelCurves::refine(const Vec2& a, const Vec2& b, double z, std::vector<Vec3>& out) const {
  std::vector<Vec2> ahead{b};
  Vec2 here = a;
  while (!ahead.empty()) {
    const Vec2 next = ahead.back();
    const double far = length(next - here);
    if (far > 0.5 * tolerance_ && ahead.size() < kSteps) {
      const std::optional<Vec2> p = between(here, next, z);
      if (p && length(*p - here) > 0.1 * tolerance_ && length(*p - next) > 0.1 * tolerance_) {
        ahead.push_back(*p);
        continue;
      }
    }
    if (out.size() % 64 == 0) base::still_wanted();
    const Vec3 from(here, z), to(next, z);
    if (const double up = scene_.surface.above(from, to); up > 0) {
      // Go over the material between both points.
      const double top = scene_.surface.over(from, to);
      out.push_back(from + Vec3(0, 0, top)), out.push_back(to + Vec3(0, 0, top));
    }
    out.push_back(to);
    here = next, ahead.pop_back();
  }
}

std::optional<SurfacePoint> LevelCurves::at_wall(const Vec2& p, double z) const {
  const double near = 2 * tolerance_;
  const SteepFaces::Found wall =
      walls_.nearest(Vec3(p, z + middle_), reach_ * (1 + kWallSlack) + near, near + scene_.options.allowance, near);
  if (wall.triangle < 0) return {};
  return SurfacePoint{Vec3(p, z), {true, z, wall.point, tool::Part::Cutter, wall.triangle}};
}

LevelCurves::Touch LevelCurves::touch(const Vec2& p, const Vec2& right, double z) const {
  SurfacePoint s{Vec3(p, z), outer_(Vec3(p, 0))};
  scene_.surface.count_drop();
  if (s.landing.touches && std::abs(z - s.landing.height) <= kClose * tolerance_) {
    if (const char* reason = scene_.surface.blocked(s)) return {false, reason};
    s.tip.z = s.landing.height;
    const double slope = scene_.surface.touched_slope(s);
    if (slope >= least_slope_ && scene_.surface.wanted_face(s.landing.triangle, s.landing.point, slope)) return {true};
  }
  // A step of the surface, or a floor next to a step: the cutter touches an upright wall with its full radius, or
  // nothing.
  const std::optional<SurfacePoint> wall = at_wall(p, z);
  if (!wall) {
    s.landing = outer_(Vec3(p + 2 * kPrecision * tolerance_ * right, 0));
    return {false, s.landing.height > z ? scene_.surface.blocked(s) : nullptr};
  }
  if (const char* reason = scene_.surface.blocked(*wall)) return {false, reason};
  const int face = wall->landing.triangle;
  return {scene_.surface.wanted_face(face, wall->landing.point, scene_.surface.face_slope(face))};
}

/// The curve's point near `p`, on the line through `p` across the curve; `p` itself if there is none.
Vec2 LevelCurves::onto(const Vec2& p, const Vec2& right, double z) const {
  const double off = 2 * kOff * tolerance_;
  const bool inside = height(p) > z;
  const Vec2 q = p + (inside ? -off : off) * right;
  if ((height(q) > z) == inside) return p;
  return inside ? border(q, p, z) : border(p, q, z);
}

/// The end of a piece, between a point on a selected face and one on another face.
Vec3 LevelCurves::end_between(const Vec3& in, const Vec3& out) const {
  const Vec2 way = Vec2(out) - Vec2(in);
  const double far = length(way);
  if (!(far > 0)) return in;
  const Vec2 right = Vec2(way.y, -way.x) / far;
  double low = 0, high = 1;
  Vec3 end = in;
  while ((high - low) * far > 0.5 * tolerance_) {
    const double middle = 0.5 * (low + high);
    const Vec2 p = onto(Vec2(in) + middle * way, right, in.z);
    if (touch(p, right, in.z).meant)
      low = middle, end = Vec3(glm::mix(in, out, middle));
    else
      high = middle;
  }
  return end;
}

void LevelCurves::keep_meant(const std::vector<Vec3>& tips, bool closed, std::vector<LevelPiece>& out,
                             std::vector<BlockedPlace>& blocked) const {
  const std::size_t n = tips.size() - (closed ? 1 : 0);
  std::vector<char> keep(n);
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t a = k > 0 ? k - 1 : closed ? n - 1 : 0, b = k + 1 < n ? k + 1 : closed ? 0 : k;
    const Vec2 way = Vec2(tips[b]) - Vec2(tips[a]);
    const double far = length(way);
    const Vec2 right = far > 0 ? Vec2(way.y, -way.x) / far : Vec2(0);
    const Touch found = touch(Vec2(tips[k]), right, tips[k].z);
    keep[k] = found.meant;
    if (found.blocked && k > 0) add_blocked_move(found.blocked, tips[k], glm::length(tips[k] - tips[k - 1]), blocked);
  }
  for (const auto& [first, count] : runs(keep, closed)) {
    if (closed && count == n) {
      out.push_back({tips, true});
      continue;
    }
    LevelPiece piece;
    const std::size_t last = first + count - 1;
    if (closed || first > 0) piece.tips.push_back(end_between(tips[first], tips[(first + n - 1) % n]));
    for (std::size_t k = first; k <= last; ++k)
      if (piece.tips.empty() || piece.tips.back() != tips[k % n]) piece.tips.push_back(tips[k % n]);
    if (closed || last + 1 < n) {
      const Vec3 end = end_between(tips[last % n], tips[(last + 1) % n]);
      if (end != piece.tips.back()) piece.tips.push_back(end);
    }
    if (piece.tips.size() > 1) out.push_back(std::move(piece));
  }
}

std::vector<LevelPiece> LevelCurves::at(double z, const PlaceSet* near, std::vector<BlockedPlace>& blocked) const {
  std::vector<std::pair<std::size_t, std::size_t>> ends;
  const std::vector<Curve> curves = contours(grid_, heights_, z, [&](std::size_t less, std::size_t more) {
    ends.emplace_back(less, more);
    return glm::mix(grid_.place(less), grid_.place(more), 0.5);
  });
  std::vector<LevelPiece> out;
  std::size_t done = 0;
  for (const Curve& curve : curves) {
    const std::size_t n = curve.points.size(), begin = std::exchange(done, done + curve.points.size());
    std::vector<char> keep(n, 1);
    for (std::size_t k = 0; near && k < n; ++k)
      keep[k] = (*near)[ends[begin + k].first] || (*near)[ends[begin + k].second];
    for (const auto& [first, count] : runs(keep, curve.closed)) {
      std::vector<Vec2> found;
      for (std::size_t i = 0; i < count; ++i) {
        const auto [less, more] = ends[begin + (first + i) % n];
        const Vec2 p = border(grid_.place(less), grid_.place(more), z);
        if (found.empty() || length(p - found.back()) > 0.1 * tolerance_) found.push_back(p);
      }
      const bool closed = curve.closed && count == n;
      if (closed && found.size() > 1 && length(found.front() - found.back()) <= 0.1 * tolerance_) found.pop_back();
      if (found.size() < 2) continue;
      std::vector<Vec3> tips{Vec3(found.front(), z)};
      for (std::size_t k = 1; k < found.size(); ++k) refine(found[k - 1], found[k], z, tips);
      if (closed) refine(found.back(), found.front(), z, tips);
      keep_meant(tips, closed, out, blocked);
    }
  }
  return out;
}

}  // namespace riffler::plan
