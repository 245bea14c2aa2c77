#include "riffler/collide/assembly.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "base/functions.hpp"
#include "collide/outline_lanes.hpp"
#include "collide/outline_runs.hpp"

namespace riffler::collide {

struct Assembly::Forms {
  OutlineRuns runs;
  std::vector<LaneEdge> lane_edges;

  explicit Forms(const std::vector<tool::OutlineEdge>& edges) : runs(edges), lane_edges(edges.begin(), edges.end()) {}
};

struct Assembly::Deepest {
  std::once_flag once;
  std::vector<Vec2> places;
};

namespace {

/// Descends to a local minimum of the distance with shrinking steps, down to rounding size.
Vec2 sink(const tool::Outline& outline, Vec2 p, double step) {
  const auto value = [&](const Vec2& q) { return outline.nearest(std::abs(q.x), q.y).distance; };
  double least = value(p);
  for (; step > 1e-13 * (1 + std::abs(p.y)); step *= 0.7)
    for (int turn = 0; turn < 16; ++turn) {
      const double angle = turn * 0.39269908169872414;
      const Vec2 q = p + step * Vec2(base::cos(angle), base::sin(angle));
      if (const double d = value(q); d < least) least = d, p = q, turn = -1;
    }
  return {std::abs(p.x), p.y};
}

std::vector<Vec2> find_deepest(const tool::Outline& outline, double width) {
  // A grid over the half-plane. From each grid point with no lower neighbour, descend.
  constexpr int kAcross = 24, kAlong = 192;
  const double low = outline.edges().front().from.y, high = outline.edges().back().to.y;
  const double du = width / kAcross, dz = (high - low) / kAlong;
  std::vector<double> f((kAcross + 1) * (kAlong + 1));
  const auto at = [&](int i, int j) -> double& { return f[static_cast<std::size_t>(std::abs(i) * (kAlong + 1) + j)]; };
  for (int i = 0; i <= kAcross; ++i)
    for (int j = 0; j <= kAlong; ++j) at(i, j) = outline.nearest(i * du, low + j * dz).distance;
  std::vector<Vec2> out;
  for (int i = 0; i <= kAcross; ++i)
    for (int j = 0; j <= kAlong; ++j) {
      bool lowest = at(i, j) < 0;
      for (int a = -1; a <= 1; ++a)
        for (int b = -1; b <= 1; ++b)
          if (i + a <= kAcross && j + b >= 0 && j + b <= kAlong && at(i + a, j + b) < at(i, j)) lowest = false;
      // If neighbours are equally deep, use one of them.
      if (!lowest || (j > 0 && at(i, j - 1) == at(i, j)) || (i > 0 && at(i - 1, j) == at(i, j))) continue;
      out.push_back(sink(outline, {i * du, low + j * dz}, std::max(du, dz)));
    }
  return out;
}

double widest(const tool::OutlineEdge& e) {
  return std::max({e.from.x, e.to.x, e.centre ? e.centre->x + e.bulge : 0});
}

}  // namespace

Assembly::Assembly(const Tool& tool)
    : tool_(tool),
      outline_(tool),
      forms_(std::make_shared<const Forms>(outline_.edges())),
      reach_(0),
      max_radius_(0),
      deepest_(std::make_shared<Deepest>()) {
  for (const tool::OutlineEdge& e : outline_.edges()) {
    reach_ = std::max({reach_, glm::length(e.from), glm::length(e.to)});
    max_radius_ = std::max(max_radius_, widest(e));
    if (e.centre) reach_ = std::max(reach_, glm::length(*e.centre) + std::abs(e.bulge));
    if (e.from.y == e.to.y) continue;
    if (stretches_.empty() || stretches_.back().part != e.part)
      stretches_.push_back({stretches_.empty() ? e.from.y : stretches_.back().high, e.to.y, e.part, 0, e.from.x, 0});
    stretches_.back().high = e.to.y, stretches_.back().top = e.to.x;
    stretches_.back().radius = std::max(stretches_.back().radius, widest(e));
  }
}

const OutlineRuns& Assembly::runs() const {
  return forms_->runs;
}

const std::vector<LaneEdge>& Assembly::lane_edges() const {
  return forms_->lane_edges;
}

tool::Part Assembly::part_at(double z) const {
  for (const HeightBand& s : stretches_)
    if (z <= s.high) return s.part;
  return stretches_.back().part;
}

const std::vector<Vec2>& Assembly::deepest() const {
  std::call_once(deepest_->once, [&] { deepest_->places = find_deepest(outline_, max_radius_); });
  return deepest_->places;
}

}  // namespace riffler::collide
