// Parallel rows: one every so often as the cusp allows on level faces, and between two of them further ones wherever
// what they leave is higher. Three things decide at places between two rows X and Y, of which the middle one is M:
// the cutter's ridge from the nearest place of a row to M and to the points half way from M to X and Y (slopes, walls
// that rows pass alongside), the distance of M's contact from the cutter on the rows (curved and creased faces), and
// whether X and Y are cut there at all (borders).
#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "geom/hypot.hpp"
#include "geom/math.hpp"
#include "plan/finish/patterns.hpp"
#include "riffler/base/parallel.hpp"
#include "riffler/tool/outline.hpp"

namespace riffler::plan {

namespace {

constexpr double kSafe = 0.9;           // of the cusp, for what is measured between neighbours of a sample
constexpr double kChecksInSpacing = 4;  // samples along a row, per spacing of rows
constexpr double kMaxRows = 1e6;

/// A row and what is cut of it. Its pieces do not overlap along x.
struct Row {
  double y = 0;
  std::vector<std::vector<Vec3>> pieces;
};

/// The nearest place of a row to `p` among those within `window` along x; none if it is not cut there.
std::optional<Vec3> nearest_on(const Row& row, const Vec3& p, double window) {
  std::optional<Vec3> best;
  double least = kInfinity;
  for (const std::vector<Vec3>& piece : row.pieces) {
    if (piece.back().x < p.x - window || piece.front().x > p.x + window) continue;
    auto it =
        std::lower_bound(piece.begin(), piece.end(), p.x - window, [](const Vec3& tip, double x) { return tip.x < x; });
    if (it != piece.begin()) --it;
    for (; it + 1 < piece.end() && it->x <= p.x + window; ++it) {
      const Vec3 way = *(it + 1) - *it;
      const double length2 = glm::dot(way, way);
      const double s = length2 > 0 ? std::clamp(glm::dot(p - *it, way) / length2, 0.0, 1.0) : 0.0;
      const Vec3 at = *it + s * way;
      if (const double d = geom::squared_length(p - at); d < least) least = d, best = at;
    }
  }
  return best;
}

class Filler {
 public:
  explicit Filler(const PatternScene& scene)
      : scene_(scene),
        outline_(scene.tool),
        cusp_(kSafe * scene.options.cusp),
        spacing_(scene.profile.spacing(cusp_)),
        finest_(std::max(scene.options.cusp, scene.options.tolerance)) {
    const double reach = scene.profile.radius() + scene.options.allowance;
    from_ = scene.part.lower.x - reach, to_ = scene.part.upper.x + reach;
    first_ = scene.part.lower.y - reach;
    const double count = std::ceil((scene.part.upper.y + reach - first_) / spacing_);
    step_ = spacing_ / kChecksInSpacing;
    if (!(count <= kMaxRows && (to_ - from_) / step_ * count < 4e9))
      throw std::invalid_argument("cusp: " + std::to_string(scene.options.cusp) +
                                  " mm needs too many rows for this tool and part; take a larger one");
    rows_ = static_cast<std::size_t>(count) + 1;
  }

  std::size_t rows() const { return rows_; }
  double spacing() const { return spacing_; }

  Row row(std::size_t k, std::vector<BlockedPlace>& blocked) const {
    const double y = first_ + static_cast<double>(k) * spacing_;
    return {y, scene_.surface.meant_pieces(scene_.surface.follow({from_, y}, {to_, y}), blocked)};
  }

  /// The rows that are missing between X and Y.
  void fill(const Row& x, const Row& y, std::vector<Row>& out) const {
    std::vector<int> all(static_cast<std::size_t>(std::ceil((to_ - from_) / step_)) + 1);
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
    fill(x, y, all, out);
  }

 private:
  double place(int sample) const { return from_ + sample * step_; }

  void fill(const Row& x, const Row& y, const std::vector<int>& samples, std::vector<Row>& out) const {
    if (y.y - x.y <= finest_) return;
    Row middle{0.5 * (x.y + y.y), {}};
    std::vector<int> open;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (i % 64 == 0) base::still_wanted();
      if (stands(x, y, middle.y, place(samples[i]))) open.push_back(samples[i]);
    }
    if (open.empty()) return;
    std::vector<BlockedPlace> ignored;  // rows of equal spacing have reported them
    std::vector<int> next;
    for (std::size_t i = 0; i < open.size();) {
      std::size_t end = i + 1;
      while (end < open.size() && open[end] <= open[end - 1] + 2) ++end;
      const double a = std::max(from_, place(open[i] - 1)), b = std::min(to_, place(open[end - 1] + 1));
      for (auto& piece : scene_.surface.meant_pieces(scene_.surface.follow({a, middle.y}, {b, middle.y}), ignored))
        middle.pieces.push_back(std::move(piece));
      for (int k = open[i] - 1; k <= open[end - 1] + 1; ++k)
        if (next.empty() || next.back() < k) next.push_back(k);
      i = end;
    }
    fill(x, middle, next, out);
    if (!middle.pieces.empty()) out.push_back(middle);
    fill(middle, y, next, out);
  }

  /// Whether what X and Y leave near x is higher than the cusp.
  bool stands(const Row& x, const Row& y, double middle, double at) const {
    const SurfacePoint m = scene_.surface.at({at, middle});
    const bool meant = scene_.surface.meant(m);
    const double window = std::max(2 * step_, 2 * (y.y - x.y)) + step_;
    const std::optional<Vec3> on_x = meant ? nearest_on(x, m.tip, window) : std::nullopt,
                              on_y = meant ? nearest_on(y, m.tip, window) : std::nullopt;
    if (meant) {
      if (!on_x && !on_y) return true;
      if ((!on_x || !on_y) && y.y - x.y > 4 * finest_) return true;  // a border runs between
      const double least = std::min(ridge_to(on_x, m.tip), ridge_to(on_y, m.tip));
      if (least > cusp_ || standing(m, on_x, on_y) > cusp_) return true;
    }
    return steps(x, y, m, at, meant, window);
  }

  double ridge_to(const std::optional<Vec3>& row, const Vec3& p) const {
    if (!row) return kInfinity;
    return scene_.profile.ridge(2 * geom::hypot(p.x - row->x, p.y - row->y), 2 * (p.z - row->z));
  }

  /// How far M's contact stands off the cutter on the nearest places of both rows.
  double standing(const SurfacePoint& m, const std::optional<Vec3>& on_x, const std::optional<Vec3>& on_y) const {
    double least = kInfinity;
    for (const std::optional<Vec3>& tip : {on_x, on_y}) {
      if (!tip) continue;
      const Vec3 off = m.landing.point - *tip;
      least = std::min(least, outline_.nearest(geom::hypot(off.x, off.y), off.z).distance - scene_.options.allowance);
    }
    return least;
  }

  /// Whether a wall or slope between M and one of the rows is left: half way to it, half as high.
  bool steps(const Row& x, const Row& y, const SurfacePoint& m, double at, bool meant, double window) const {
    if (!m.landing.touches) return false;
    for (const Row* side : {&x, &y}) {
      const SurfacePoint s = scene_.surface.at({at, side->y});
      if (!s.landing.touches || !(meant || scene_.surface.meant(s))) continue;
      const double across = std::abs(side->y - m.tip.y), up = std::abs(s.tip.z - m.tip.z);
      if (!scene_.surface.meant_slope(std::atan2(up, across))) continue;
      if (scene_.profile.ridge(across, up) <= cusp_) continue;
      const Vec3 p = 0.5 * (s.tip + m.tip);
      if (std::min(ridge_to(nearest_on(x, p, window), p), ridge_to(nearest_on(y, p, window), p)) > cusp_) return true;
    }
    return false;
  }

  const PatternScene& scene_;
  tool::Outline outline_;
  double cusp_, spacing_, finest_, step_ = 0, from_ = 0, to_ = 0, first_ = 0;
  std::size_t rows_ = 0;
};

void add_blocked(const std::vector<BlockedPlace>& more, std::vector<BlockedPlace>& all) {
  for (const BlockedPlace& one : more) {
    const auto same =
        std::find_if(all.begin(), all.end(), [&](const BlockedPlace& b) { return b.reason == one.reason; });
    if (same == all.end())
      all.push_back(one);
    else
      same->length += one.length;
  }
}

}  // namespace

PatternRows parallel_rows(const PatternScene& scene, const Progress& progress) {
  const Filler filler(scene);
  const std::size_t n = filler.rows();
  std::vector<Row> rows(n);
  std::vector<std::vector<BlockedPlace>> blocked(n);
  base::parallel_for(
      n, 1,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) rows[k] = filler.row(k, blocked[k]);
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
    for (const std::vector<Vec3>& piece : row.pieces) out.pieces.push_back({row.y, piece});
    return row.pieces.empty() ? std::size_t{0} : std::size_t{1};
  };
  for (std::size_t k = 0; k < n; ++k) {
    out.rows += add(rows[k]);
    if (k < between.size())
      for (const Row& row : between[k]) out.added += add(row);
    add_blocked(blocked[k], out.blocked);
  }
  return out;
}

}  // namespace riffler::plan
