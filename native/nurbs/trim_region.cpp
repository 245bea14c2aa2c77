#include "nurbs/trim_region.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace riffler::nurbs {

namespace {

constexpr std::size_t kMaxBands = 4096;
constexpr double kStraight = 1e-14;  // of the squared size of a loop: area at a point that can be left out

double cross(const Vec2& a, const Vec2& b) {
  return a.x * b.y - a.y * b.x;
}

/// The loop without points that lie on the line between their neighbours.
std::vector<Vec2> without_straight_points(const std::vector<Vec2>& loop) {
  Vec2 lower = loop[0], upper = loop[0];
  for (const Vec2& p : loop) lower = glm::min(lower, p), upper = glm::max(upper, p);
  const Vec2 size = upper - lower;
  const double most = kStraight * size.x * size.y;
  std::vector<Vec2> out;
  for (const Vec2& p : loop) {
    while (out.size() > 1 && std::abs(cross(out.back() - out[out.size() - 2], p - out.back())) <= most &&
           glm::dot(out.back() - out[out.size() - 2], p - out.back()) >= 0)
      out.pop_back();
    if (out.empty() || out.back() != p) out.push_back(p);
  }
  return out;
}

}  // namespace

double TrimRegion::Edge::u(double v) const {
  if (v <= a.y) return a.x;
  if (v >= b.y) return b.x;
  const double t = (v - a.y) / (b.y - a.y), u = a.x + t * (b.x - a.x);
  return std::clamp(u, std::min(a.x, b.x), std::max(a.x, b.x));
}

TrimRegion::TrimRegion(const std::vector<std::vector<Vec2>>& loops) : closed_(!loops.empty()) {
  for (const std::vector<Vec2>& given : loops) {
    const std::vector<Vec2> loop = without_straight_points(given);
    for (std::size_t i = 0; i < loop.size(); ++i) {
      Vec2 a = loop[i], b = loop[(i + 1) % loop.size()];
      if (a.y > b.y) std::swap(a, b);
      if (a != b) edges_.push_back({a, b});
    }
  }
  sort_into_bands();
}

void TrimRegion::sort_into_bands() {
  if (edges_.empty()) return;
  double high = edges_[0].b.y;
  low_ = edges_[0].a.y;
  for (const Edge& e : edges_) low_ = std::min(low_, e.a.y), high = std::max(high, e.b.y);
  bands_.resize(std::min(edges_.size(), kMaxBands));
  per_band_ = high > low_ ? static_cast<double>(bands_.size()) / (high - low_) : 0;
  const auto band = [&](double v) {
    return static_cast<std::size_t>(
        std::clamp(std::floor((v - low_) * per_band_), 0.0, static_cast<double>(bands_.size() - 1)));
  };
  for (std::uint32_t i = 0; i < edges_.size(); ++i)
    for (std::size_t k = band(edges_[i].a.y); k <= band(edges_[i].b.y); ++k) bands_[k].push_back(i);
}

/// By the edges to the left on the line of constant v.
bool TrimRegion::holds(const Vec2& p) const {
  if (edges_.empty()) return !closed_;
  const double k = std::floor((p.y - low_) * per_band_);
  if (!(k >= 0)) return false;
  bool inside = false;
  for (const std::uint32_t i : bands_[std::min(static_cast<std::size_t>(k), bands_.size() - 1)])
    if (edges_[i].spans(p.y) && edges_[i].u(p.y) < p.x) inside = !inside;
  return inside;
}

TrimRegion::Edges TrimRegion::all() const {
  Edges out(edges_.size());
  std::iota(out.begin(), out.end(), 0U);
  return out;
}

TrimRegion::Edges TrimRegion::touching(const Edges& some, const Vec2& lower, const Vec2& upper) const {
  Edges out;
  for (const std::uint32_t i : some) {
    const auto& [a, b] = edges_[i];
    if (std::max(a.x, b.x) < lower.x || std::min(a.x, b.x) > upper.x || b.y < lower.y || a.y > upper.y) continue;
    const Vec2 way = b - a;
    double least = cross(way, lower - a), most = least;
    for (const Vec2& corner : {Vec2(upper.x, lower.y), upper, Vec2(lower.x, upper.y)})
      least = std::min(least, cross(way, corner - a)), most = std::max(most, cross(way, corner - a));
    if (least <= 0 && most >= 0) out.push_back(i);
  }
  return out;
}

/// The lines of constant v between which no edge begins, ends, meets another, or meets a side of the rectangle.
std::vector<double> TrimRegion::slabs(const Edges& edges, const Vec2& lower, const Vec2& upper) const {
  std::vector<double> out{lower.y, upper.y};
  const auto add = [&](double v) {
    if (v > lower.y && v < upper.y) out.push_back(v);
  };
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Edge& e = edges_[edges[i]];
    const Vec2 way = e.b - e.a;
    add(e.a.y), add(e.b.y);
    for (const double side : {lower.x, upper.x})
      if ((e.a.x < side) != (e.b.x < side)) add(e.a.y + (side - e.a.x) / way.x * way.y);
    for (std::size_t j = 0; j < i; ++j) {
      const Edge& f = edges_[edges[j]];
      const double turn = cross(way, f.b - f.a);
      if (turn == 0) continue;
      const double t = cross(f.a - e.a, f.b - f.a) / turn, s = cross(f.a - e.a, way) / turn;
      if (t > 0 && t < 1 && s > 0 && s < 1) add(e.a.y + t * way.y);
    }
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

void TrimRegion::append_pieces(const Edges& edges, const Vec2& lower, const Vec2& upper,
                               std::vector<Trapezoid>& out) const {
  const std::vector<double> lines = slabs(edges, lower, upper);
  const Vec2 size = upper - lower;
  std::vector<std::pair<double, std::uint32_t>> crossed;
  for (std::size_t k = 0; k + 1 < lines.size(); ++k) {
    const double low = lines[k], high = lines[k + 1], middle = 0.5 * (low + high);
    crossed.clear();
    for (const std::uint32_t i : edges)
      if (edges_[i].spans(middle))
        if (const double u = edges_[i].u(middle); u >= lower.x && u < upper.x) crossed.emplace_back(u, i);
    std::sort(crossed.begin(), crossed.end());
    bool inside = holds({lower.x, middle});
    double left[2] = {0, 0};
    const auto add = [&](double right_low, double right_high) {
      if (right_low > left[0] || right_high > left[1])
        out.push_back({(low - lower.y) / size.y,
                       k + 2 == lines.size() ? 1 : (high - lower.y) / size.y,
                       {left[0], left[1]},
                       {std::max(left[0], right_low), std::max(left[1], right_high)}});
    };
    for (const auto& [u, i] : crossed) {
      const auto within = [&](double v) { return std::clamp((edges_[i].u(v) - lower.x) / size.x, 0.0, 1.0); };
      if (inside) add(within(low), within(high));
      inside = !inside, left[0] = within(low), left[1] = within(high);
    }
    if (inside) add(1, 1);
  }
}

}  // namespace riffler::nurbs
