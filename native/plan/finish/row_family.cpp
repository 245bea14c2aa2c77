#include "plan/finish/row_family.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/functions.hpp"
#include "geom/hypot.hpp"
#include "geom/math.hpp"
#include "riffler/base/parallel.hpp"
#include "riffler/tool/outline.hpp"

namespace riffler::plan {

namespace {

constexpr int kCreaseHalves = 4;

/// A row, and the pieces of it that are cut. Pieces do not overlap along u.
struct Row {
  struct Piece {
    std::vector<Vec3> tips;
    std::vector<double> along;  // u of each tip
  };
  double v = 0;
  std::vector<Piece> pieces;
};

/// The place of a row nearest to `p`, among places whose u is within `window` of `u`; none if the row is not cut there.
std::optional<Vec3> nearest_on(const Row& row, const Vec3& p, double u, double window) {
  std::optional<Vec3> best;
  double least = kInfinity;
  for (const auto& [tips, along] : row.pieces) {
    if (along.back() < u - window || along.front() > u + window) continue;
    auto k = static_cast<std::size_t>(std::lower_bound(along.begin(), along.end(), u - window) - along.begin());
    if (k > 0) --k;
    for (; k + 1 < tips.size() && along[k] <= u + window; ++k) {
      const Vec3 way = tips[k + 1] - tips[k];
      const double length2 = glm::dot(way, way);
      const double s = length2 > 0 ? std::clamp(glm::dot(p - tips[k], way) / length2, 0.0, 1.0) : 0.0;
      const Vec3 at = tips[k] + s * way;
      if (const double d = geom::squared_length(p - at); d < least) least = d, best = at;
    }
  }
  return best;
}

class Filler {
 public:
  Filler(const PatternScene& scene, const RowFamily& family)
      : scene_(scene),
        family_(family),
        outline_(scene.tool),
        cusp_(kCuspShare * scene.options.cusp),
        spacing_(scene.profile.spacing(cusp_)),
        finest_(std::max(scene.options.cusp, scene.options.tolerance)),
        reach_(scene.profile.radius() + scene.options.allowance),
        count_(static_cast<int>(std::ceil((family.to - family.from) / family.step)) + 1) {}

  double spacing() const { return spacing_; }

  Row row(double v, std::vector<BlockedPlace>& blocked) const {
    Row out{v, {}};
    std::vector<int> samples;
    for (int i = 0; i < count_; ++i)
      if (near_region(i, v)) samples.push_back(i);
    add_around(out, samples, blocked);
    return out;
  }

  /// Adds the rows that are needed between X and Y.
  void fill(const Row& x, const Row& y, std::vector<Row>& out) const {
    std::vector<int> samples;
    for (int i = 0; i < count_; ++i)
      if (near_region(i, x.v) || near_region(i, 0.5 * (x.v + y.v)) || near_region(i, y.v)) samples.push_back(i);
    if (!samples.empty()) fill(x, y, samples, out);
  }

 private:
  double place(int sample) const { return family_.from + sample * family_.step; }

  std::vector<Vec2> line(double a, double b, double v) const {
    std::vector<Vec2> out{family_.at(a, v)};
    if (family_.chord)
      for (double u = a + family_.chord(a, v); u < b; u += family_.chord(u, v)) out.push_back(family_.at(u, v));
    out.push_back(family_.at(b, v));
    return out;
  }

  /// Adds the pieces of a row that are cut between u = `a` and u = `b`.
  void add_pieces(Row& row, double a, double b, std::vector<BlockedPlace>& blocked) const {
    const std::vector<SurfacePoint> points =
        scene_.surface.sampled(scene_.surface.follow(line(a, b, row.v)), 0.5 * spacing_);
    for (std::vector<Vec3>& tips : scene_.surface.meant_pieces(points, blocked)) {
      Row::Piece& piece = row.pieces.emplace_back(Row::Piece{std::move(tips), {}});
      double last = -kInfinity;
      for (const Vec3& tip : piece.tips)
        piece.along.push_back(last = std::max(last, std::clamp(family_.along(Vec2(tip), row.v), a, b)));
    }
  }

  /// Adds the pieces of a row around samples, which are ascending. Returns these samples and their neighbours.
  std::vector<int> add_around(Row& row, const std::vector<int>& samples, std::vector<BlockedPlace>& blocked) const {
    std::vector<int> out;
    for (std::size_t i = 0; i < samples.size();) {
      std::size_t end = i + 1;
      while (end < samples.size() && samples[end] <= samples[end - 1] + 2) ++end;
      add_pieces(row, std::max(family_.from, place(samples[i] - 1)), std::min(family_.to, place(samples[end - 1] + 1)),
                 blocked);
      for (int k = samples[i] - 1; k <= samples[end - 1] + 1; ++k)
        if (out.empty() || out.back() < k) out.push_back(k);
      i = end;
    }
    return out;
  }

  /// Whether the cutter may touch the region at places of row `v` around a sample.
  bool near_region(int sample, double v) const {
    const double u = std::min(place(sample), family_.to);
    return scene_.surface.may_want(family_.at(u, v), reach_ + 2 * family_.step * family_.pace(u, v));
  }

  void fill(const Row& x, const Row& y, const std::vector<int>& samples, std::vector<Row>& out) const {
    Row middle{0.5 * (x.v + y.v), {}};
    std::vector<int> open;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (i % 64 == 0) base::still_wanted();
      const double u = place(samples[i]), apart = family_.apart(std::min(u, family_.to), x.v, y.v);
      if (apart > finest_ && stands(x, y, middle.v, u, apart)) open.push_back(samples[i]);
    }
    if (open.empty()) return;
    std::vector<BlockedPlace> ignored;  // the first rows have reported them
    const std::vector<int> next = add_around(middle, open, ignored);
    fill(x, middle, next, out);
    if (!middle.pieces.empty()) out.push_back(middle);
    fill(middle, y, next, out);
  }

  /// Whether X and Y leave material higher than the cusp near u.
  bool stands(const Row& x, const Row& y, double middle, double u, double apart) const {
    if (apart > 1.5 * spacing_) return true;  // one sample is not enough
    const SurfacePoint m = scene_.surface.at(family_.at(u, middle));
    const bool meant = scene_.surface.meant(m);
    const double samples = family_.step * family_.pace(u, middle);  // mm
    const double window = (std::max(2 * samples, 2 * apart) + samples) * family_.step / samples;
    const std::optional<Vec3> on_x = meant ? nearest_on(x, m.tip, u, window) : std::nullopt,
                              on_y = meant ? nearest_on(y, m.tip, u, window) : std::nullopt;
    if (meant) {
      if (!on_x && !on_y) return true;
      if ((!on_x || !on_y) && apart > 4 * finest_) return true;  // a border runs between
      const double least = std::min(ridge_to(on_x, m.tip), ridge_to(on_y, m.tip));
      if (least > cusp_ || standing(m, on_x, on_y) > cusp_) return true;
    }
    return walled(x, y, m, u, meant, window) || creased(x, y, u, window);
  }

  /// Whether more than the cusp stays on either side of the middle, or at a crease along which the rows run.
  bool creased(const Row& x, const Row& y, double u, double window) const {
    const auto at = [&](double share) { return scene_.surface.at(family_.at(u, glm::mix(x.v, y.v, share))); };
    const auto high = [&](const SurfacePoint& p) {
      if (!scene_.surface.meant(p)) return false;
      const std::optional<Vec3> on_x = nearest_on(x, p.tip, u, window), on_y = nearest_on(y, p.tip, u, window);
      return (on_x || on_y) && standing(p, on_x, on_y) > cusp_;
    };
    SurfacePoint last = at(0);
    for (const double share : {0.25, 0.5, 0.75, 1.0}) {
      const SurfacePoint here = at(share);
      if (high(here)) return true;
      double low = share - 0.25, up = share;
      SurfacePoint before = last;
      for (int k = 0; k < kCreaseHalves && scene_.surface.creased(before, here); ++k) {
        const double middle = 0.5 * (low + up);
        const SurfacePoint p = at(middle);
        if (high(p)) return true;
        if (scene_.surface.creased(before, p))
          up = middle;
        else
          low = middle, before = p;
      }
      last = here;
    }
    return false;
  }

  double ridge_to(const std::optional<Vec3>& row, const Vec3& p) const {
    if (!row) return kInfinity;
    return scene_.profile.ridge(2 * geom::hypot(p.x - row->x, p.y - row->y), 2 * (p.z - row->z));
  }

  /// Smallest distance of M's contact from the cutter at the nearest place of each row.
  double standing(const SurfacePoint& m, const std::optional<Vec3>& on_x, const std::optional<Vec3>& on_y) const {
    double least = kInfinity;
    for (const std::optional<Vec3>& tip : {on_x, on_y}) {
      if (!tip) continue;
      const Vec3 off = m.landing.point - *tip;
      least = std::min(least, outline_.nearest(geom::hypot(off.x, off.y), off.z).distance - scene_.options.allowance);
    }
    return least;
  }

  /// Whether the rows leave material on a wall or slope between M and one row: half way to the row, at half the height.
  bool walled(const Row& x, const Row& y, const SurfacePoint& m, double u, bool meant, double window) const {
    if (!m.landing.touches) return false;
    for (const Row* side : {&x, &y}) {
      const SurfacePoint s = scene_.surface.at(family_.at(u, side->v));
      if (!s.landing.touches || !(meant || scene_.surface.meant(s))) continue;
      const double across = geom::hypot(s.tip.x - m.tip.x, s.tip.y - m.tip.y), up = std::abs(s.tip.z - m.tip.z);
      if (!scene_.surface.meant_slope(base::atan2(up, across))) continue;
      if (scene_.profile.ridge(across, up) <= cusp_) continue;
      const Vec3 p = 0.5 * (s.tip + m.tip);
      if (std::min(ridge_to(nearest_on(x, p, u, window), p), ridge_to(nearest_on(y, p, u, window), p)) > cusp_)
        return true;
    }
    return false;
  }

  const PatternScene& scene_;
  const RowFamily& family_;
  tool::Outline outline_;
  double cusp_, spacing_, finest_;
  double reach_;  // largest distance of a contact from the cutter's axis, mm
  int count_;     // number of samples along a row
};

}  // namespace

PatternRows family_rows(const PatternScene& scene, const RowFamily& family, const Progress& progress) {
  const Filler filler(scene, family);
  const std::size_t n = family.first.size();
  std::vector<Row> rows(n);
  std::vector<std::vector<BlockedPlace>> blocked(n);
  base::parallel_for(
      n, 1,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) rows[k] = filler.row(family.first[k], blocked[k]);
      },
      base::part(progress, 0, 0.4));
  std::vector<std::vector<Row>> between(n - 1);
  base::parallel_for(
      n - 1, 1,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) filler.fill(rows[k], rows[k + 1], between[k]);
      },
      base::part(progress, 0.4, 1));
  PatternRows out;
  out.spacing = filler.spacing();
  const auto add = [&](const Row& row) {
    for (const Row::Piece& piece : row.pieces) out.pieces.push_back({row.v, piece.tips});
    return row.pieces.empty() ? std::size_t{0} : std::size_t{1};
  };
  for (std::size_t k = 0; k < n - (family.ring ? 1 : 0); ++k) {
    out.rows += add(rows[k]);
    if (k < between.size())
      for (const Row& row : between[k]) out.added += add(row);
    add_blocked(blocked[k], out.blocked);
  }
  return out;
}

Vec2 centre_of(const PatternScene& scene) {
  return scene.centre ? *scene.centre : Vec2(0.5 * (scene.part.lower + scene.part.upper));
}

double farthest_from(const PatternScene& scene, const Vec2& centre) {
  const auto side = [&](int axis) {
    return std::max(std::abs(scene.part.lower[axis] - centre[axis]), std::abs(scene.part.upper[axis] - centre[axis])) +
           scene.profile.radius() + scene.options.allowance;
  };
  return geom::hypot(side(0), side(1));
}

}  // namespace riffler::plan
