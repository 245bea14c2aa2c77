#include "riffler/plan/least_tilt.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "base/functions.hpp"
#include "geom/directions.hpp"
#include "riffler/base/check.hpp"

namespace riffler::plan {

namespace {

constexpr double kNoAngle = std::numeric_limits<double>::infinity();
constexpr double kMapped = 0.9;  // fraction of the work spent on the maps

/// The free nodes of one point's map.
struct Layer {
  std::vector<Vec3> axes;
  std::vector<double> angles;
};

/// Cost of the best path to every node of a layer, and its predecessor in the layer before.
struct LayerCosts {
  std::vector<double> cost;
  std::vector<std::size_t> from;

  bool reached() const {
    return std::any_of(cost.begin(), cost.end(), [](double c) { return c < kNoAngle; });
  }
};

class Chain {
 public:
  /// Keeps references to `rule` and `progress`, which it calls once per layer.
  Chain(std::vector<Layer> layers, const TiltRule& rule, const Progress& progress)
      : layers_(std::move(layers)), rule_(rule), progress_(progress) {}

  const Layer& layer(std::size_t k) const { return layers_[k % layers_.size()]; }

  LayerCosts first(std::size_t k) const {
    LayerCosts out{{}, std::vector<std::size_t>(layer(k).axes.size(), 0)};
    for (const double a : layer(k).angles) out.cost.push_back(a * a);
    return out;
  }
  /// Costs that allow only node `i` of layer `k`.
  LayerCosts only(std::size_t k, std::size_t i) const {
    LayerCosts out = first(k);
    for (std::size_t j = 0; j < out.cost.size(); ++j)
      if (j != i) out.cost[j] = kNoAngle;
    return out;
  }
  LayerCosts next(const LayerCosts& before, std::size_t k) const {
    const Layer &a = layer(k - 1), &b = layer(k);
    const double least = base::cos(std::min(rule_.max_change, 3.2)) - 1e-12;
    LayerCosts out{std::vector<double>(b.axes.size(), kNoAngle), std::vector<std::size_t>(b.axes.size(), 0)};
    for (std::size_t j = 0; j < b.axes.size(); ++j) {
      for (std::size_t i = 0; i < a.axes.size(); ++i) {
        if (!(before.cost[i] < out.cost[j]) || glm::dot(a.axes[i], b.axes[j]) < least) continue;
        const double turn = geom::angle_between(a.axes[i], b.axes[j]);
        const double cost = before.cost[i] + rule_.smoothness * turn * turn;
        if (turn <= rule_.max_change + 1e-12 && cost < out.cost[j]) out.cost[j] = cost, out.from[j] = i;
      }
      out.cost[j] += b.angles[j] * b.angles[j];
    }
    return out;
  }

  /// Steps over layers 0 … count − 1, starting from `start`; fewer if some layer cannot be reached.
  std::vector<LayerCosts> run(LayerCosts start, std::size_t count) const {
    std::vector<LayerCosts> out{std::move(start)};
    while (out.size() < count && out.back().reached()) {
      base::report(progress_, kMapped);
      out.push_back(next(out.back(), out.size()));
    }
    return out;
  }
  static std::size_t best(const LayerCosts& step) {
    return static_cast<std::size_t>(std::min_element(step.cost.begin(), step.cost.end()) - step.cost.begin());
  }
  /// The nodes that lead to `node` of the last step.
  static std::vector<std::size_t> trace(const std::vector<LayerCosts>& steps, std::size_t node) {
    std::vector<std::size_t> out(steps.size(), node);
    for (std::size_t k = steps.size() - 1; k > 0; --k) out[k - 1] = steps[k].from[out[k]];
    return out;
  }

 private:
  std::vector<Layer> layers_;
  const TiltRule& rule_;
  const Progress& progress_;
};

/// The best lap that returns to its first node: one node more than layers; empty if no start allows one.
std::vector<std::size_t> best_round(const Chain& chain, std::size_t n) {
  std::vector<std::size_t> starts(chain.layer(0).axes.size());
  std::iota(starts.begin(), starts.end(), std::size_t{0});
  const std::vector<LayerCosts> laps = chain.run(chain.first(0), 2 * n);
  if (laps.size() < 2 * n) return {};
  std::stable_sort(starts.begin(), starts.end(),
                   [&](std::size_t a, std::size_t b) { return laps[n].cost[a] < laps[n].cost[b]; });
  const std::size_t middle = Chain::trace(laps, Chain::best(laps.back()))[n];
  std::rotate(starts.begin(), std::find(starts.begin(), starts.end(), middle), starts.end());
  for (const std::size_t start : starts) {
    const std::vector<LayerCosts> round = chain.run(chain.only(0, start), n + 1);
    if (round.size() == n + 1 && round.back().cost[start] < kNoAngle) return Chain::trace(round, start);
  }
  return {};
}

void check(const PencilPath& path, const TiltRule& rule) {
  if (path.size() == 0) throw std::invalid_argument("path: has no points");
  base::require_positive(rule.max_change, "max_change", base::kPositiveAndFinite);
  base::require_not_negative(rule.smoothness, "smoothness", base::kFiniteAndNotNegative);
}

TiltAnswer none(std::size_t point, std::string reason) {
  TiltAnswer out;
  out.point = point, out.reason = "point " + std::to_string(point) + ": " + std::move(reason);
  return out;
}

}  // namespace

TiltAnswer least_tilt(const PencilPath& path, const collide::Assembly& assembly, const collide::Collider& collider,
                      const TiltRule& rule, const Progress& progress) {
  check(path, rule);
  const std::size_t n = path.size();
  std::vector<std::size_t> points(n);
  std::iota(points.begin(), points.end(), std::size_t{0});
  MapRule states = rule.map;
  states.clearances = false;
  const std::vector<OrientationMap> maps =
      orientation_maps(path, points, assembly, collider, states, base::part(progress, 0, kMapped));
  std::vector<Layer> layers(n);
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t i = 0; i < maps[k].axes.size(); ++i)
      if (maps[k].state[i] == OrientationMap::State::Free)
        layers[k].axes.push_back(maps[k].axes[i]),
            layers[k].angles.push_back(geom::angle_between(maps[k].axes[i], maps[k].frame.z));
    if (layers[k].axes.empty())
      return none(
          k, "no orientation is free: " + orientation_maps(path, {k}, assembly, collider, rule.map).front().why_none());
  }
  const Chain chain(std::move(layers), rule, progress);
  const std::vector<LayerCosts> steps = chain.run(chain.first(0), n);
  if (!steps.back().reached())
    return none(steps.size() - 1, "none of its free orientations is within max_change of those before it");
  std::vector<std::size_t> nodes = Chain::trace(steps, Chain::best(steps.back()));
  if (path.closed && n > 1) nodes = best_round(chain, n);
  if (nodes.empty()) return none(0, "no free orientation here can be reached again within max_change after one lap");
  TiltAnswer out;
  out.found = true;
  const auto turned = [&](const Vec3& a, const Vec3& b) {
    const double turn = geom::angle_between(a, b);
    out.cost += rule.smoothness * turn * turn;
  };
  for (std::size_t k = 0; k < n; ++k) {
    out.axes.push_back(chain.layer(k).axes[nodes[k]]), out.angles.push_back(chain.layer(k).angles[nodes[k]]);
    out.cost += out.angles[k] * out.angles[k];
    if (k > 0) turned(out.axes[k - 1], out.axes[k]);
  }
  if (path.closed && n > 1) turned(out.axes.back(), out.axes.front());
  base::report(progress, 1);
  return out;
}

}  // namespace riffler::plan
