#include "marching/adaptive_state.hpp"

#include <algorithm>

#include "base/sort_unique.hpp"

namespace riffler::marching {

AdaptiveState::AdaptiveState(const Surface& surface, double tolerance, bool follows)
    : surface_(surface), tolerance_(tolerance), follows_(follows), groups_(surface) {}

void AdaptiveState::build(const std::vector<std::size_t>& all, const Progress& progress) {
  layers_.clear();
  layers_.emplace_back().results.resize(surface_.bricks.size());
  shown_.assign(surface_.bricks.size(), nullptr);
  simplify(all, progress);
  shown_.clear();
  for (const auto& results : layers_.back().results) shown_.push_back(results[0]);
}

std::vector<std::size_t> AdaptiveState::update(const std::vector<std::size_t>& changed) {
  simplify(changed, {});
  std::vector<std::size_t> out;
  for (std::size_t n = 0; n < shown_.size(); ++n) {
    Result& shown = shown_[n];
    const Result& now = layers_.back().results[n][0];
    if (shown == now) continue;
    if ((now ? now->triangles.size() : 0) != count(n) || (now && shown && now->patch != shown->patch)) out.push_back(n);
    shown = now;
  }
  return out;
}

void AdaptiveState::simplify(const std::vector<std::size_t>& changed, const Progress& progress) {
  std::vector<std::size_t> active;
  for (const std::size_t n : changed)
    if (surface_.bricks.active(n)) active.push_back(n);
  groups_.sort(active, base::part(progress, 0, 0.1));
  follow(0, changed, {}, base::part(progress, 0.1, 1));
  if (!follows_) return fix_folds_in_place();
  for (std::size_t n = 0;; ++n) {
    FixedVertices fixed = fixed_after(layers_[n]);
    if (fixed == layers_[n].fixed) {
      layers_.resize(n + 1);
      return;
    }
    const bool is_new = n + 1 == layers_.size();
    if (is_new) layers_.push_back(Layer(layers_[n]));
    FixedVertices& was = layers_[n + 1].fixed;
    const std::vector<std::size_t> owners = owners_of_changes(was, fixed);
    was = std::move(fixed);
    follow(n + 1, is_new ? std::vector<std::size_t>{} : changed, owners, {});
  }
}

/// Turns the one layer into the next until no more triangles fold.
void AdaptiveState::fix_folds_in_place() {
  for (Layer& layer = layers_.front();;) {
    FixedVertices fixed = fixed_after(layer);
    const std::vector<std::size_t> owners = owners_of_changes(layer.fixed, fixed);
    if (owners.empty()) return;
    layer.fixed = std::move(fixed);
    follow(0, {}, owners, {});
  }
}

/// The bricks that have not the same fixed vertices in both.
std::vector<std::size_t> AdaptiveState::owners_of_changes(const FixedVertices& a, const FixedVertices& b) {
  std::vector<std::size_t> out;
  const auto compare = [&](const FixedVertices& one, const FixedVertices& other) {
    for (const auto& [brick, list] : one)
      if (const auto there = other.find(brick); there == other.end() || there->second != list) out.push_back(brick);
  };
  compare(a, b), compare(b, a);
  base::sort_unique(out);
  return out;
}

/// The vertices to be fixed in the next layer.
AdaptiveState::FixedVertices AdaptiveState::fixed_after(const Layer& layer) const {
  FixedVertices out = layer.fixed;
  for (const auto& [brick, names] : layer.folds)
    for (const VertexName& name : names) {
      const Vec3i at = surface_.bricks.place(brick) + name.offset();
      out[surface_.bricks.index(at.x, at.y, at.z)].push_back(name.local());
    }
  for (auto& [brick, list] : out) base::sort_unique(list);
  return out;
}

/// Finds the folded triangles of bricks with a new result, and of those that fold with them or did so before.
void AdaptiveState::find_folds(Layer& layer, const std::vector<std::size_t>& renewed) const {
  std::vector<std::size_t> others;
  if (!layer.folds.empty())
    for (const auto& [brick, names] : layer.folds) {
      const Vec3i at = surface_.bricks.place(brick);
      const bool near = std::any_of(renewed.begin(), renewed.end(), [&](std::size_t n) {
        const Vec3i d = glm::abs(surface_.bricks.place(n) - at);
        return std::max({d.x, d.y, d.z}) <= 1;
      });
      if (near) others.push_back(brick);
    }
  const auto find = [&](std::size_t n, std::vector<std::size_t>& with) {
    std::vector<VertexName> found = folds_of(layer, n, with);
    if (found.empty())
      layer.folds.erase(n);
    else
      layer.folds[n] = std::move(found);
  };
  for (const std::size_t n : renewed) find(n, others);
  base::sort_unique(others);
  std::vector<std::size_t> ignored;
  for (const std::size_t n : others) find(n, ignored);
}

/// The corners of a brick's triangles that lie on another one. Adds the bricks of those to `others`.
std::vector<VertexName> AdaptiveState::folds_of(const Layer& layer, std::size_t brick,
                                                std::vector<std::size_t>& others) const {
  std::vector<VertexName> out;
  const GroupResult* const here = layer.results[brick][0].get();
  if (!here) return out;
  const Vec3i at = surface_.bricks.place(brick);
  const auto add = [&](std::uint32_t t) {
    for (const VertexName& v : here->corners(t)) out.push_back(v);
  };
  for (const std::uint32_t t : here->folded) add(t);
  for (const GroupResult::Rim& side : here->rim) {
    const VertexName a = here->names[side.lower], b = here->names[side.upper];
    // The other triangle's brick has both vertices in itself or in the bricks below it.
    const Vec3i from = glm::max(a.offset(), b.offset()), to = glm::min(a.offset(), b.offset()) + 1;
    for (int i = from.x; i <= to.x; ++i)
      for (int j = from.y; j <= to.y; ++j)
        for (int k = from.z; k <= to.z; ++k) {
          const Vec3i by(i, j, k), place = at + by;
          if (by == Vec3i(0) || !surface_.bricks.has(place.x, place.y, place.z)) continue;
          const std::size_t n = surface_.bricks.index(place.x, place.y, place.z);
          const GroupResult* const there = layer.results[n][0].get();
          if (!there) continue;
          const auto find = [&](const VertexName& v) {
            const VertexName seen = v.seen_from(by);
            const auto found = std::lower_bound(there->names.begin(), there->names.end(), seen);
            return found != there->names.end() && *found == seen
                       ? static_cast<std::int32_t>(found - there->names.begin())
                       : -1;
          };
          const std::int32_t lower = find(a), upper = lower < 0 ? -1 : find(b);
          if (upper < 0) continue;
          const auto found = std::lower_bound(there->rim.begin(), there->rim.end(), GroupResult::Rim{lower, upper, 0});
          if (found == there->rim.end() || found->lower != lower || found->upper != upper) continue;
          if (!lie_on(surface_.mesh.vertices, numbers(at, here->corners(side.triangle)),
                      numbers(place, there->corners(found->triangle))))
            continue;
          add(side.triangle);
          others.push_back(n);
        }
  }
  base::sort_unique(out);
  return out;
}

}  // namespace riffler::marching
