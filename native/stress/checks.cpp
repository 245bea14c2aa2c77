#include "stress/checks.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "geom/hypot.hpp"

namespace riffler::stress {

namespace {

template <class... Parts>
Problem say(const Parts&... parts) {
  std::ostringstream out;
  out.precision(17);
  (out << ... << parts);
  return out.str();
}

Problem check_ray(const dexel::Grid& grid, const dexel::Tile& tile, int r) {
  const double lower = grid.box().lower.z, upper = grid.box().upper.z;
  double last = -std::numeric_limits<double>::infinity();
  for (const dexel::Span& s : tile.ray(r)) {
    if (!std::isfinite(s.near) || !std::isfinite(s.far)) return say("a span is not finite");
    if (!(s.near < s.far)) return say("the span ", s.near, " … ", s.far, " is empty");
    if (!(s.near > last))
      return say("the span at ", s.near, " does not lie above the one before, which ends at ", last);
    if (s.near < lower || s.far > upper) return say("the span ", s.near, " … ", s.far, " leaves the box");
    if (s.near < tile.reach.near || s.far > tile.reach.far) return say("the tile's reach does not cover a span");
    last = s.far;
  }
  for (const dexel::SpanNormals& n : tile.ray_normals(r))
    for (const dexel::PackedNormal& packed : {n.near, n.far})
      if (!(std::abs(glm::length(packed.unpack()) - 1) < 1e-3)) return say("a normal is not a unit vector");
  return {};
}

Problem check_tile(const dexel::Grid& grid, std::size_t index) {
  const dexel::Tile& tile = grid.tile(index);
  if (tile.offset[0] != 0 || tile.offset[dexel::kTileRays] != tile.spans.size())
    return say("offsets do not fit the spans");
  if (grid.has_normals() && tile.normals.size() != tile.spans.size())
    return say("the number of normals differs from that of spans");
  const int u = static_cast<int>(index) / grid.tiles_v() * dexel::kTileSide,
            v = static_cast<int>(index) % grid.tiles_v() * dexel::kTileSide;
  for (int r = 0; r < dexel::kTileRays; ++r) {
    if (tile.offset[r] > tile.offset[r + 1]) return say("offsets fall");
    const bool beyond = u + r / dexel::kTileSide >= grid.nu() || v + r % dexel::kTileSide >= grid.nv();
    if (beyond && !tile.ray(r).empty()) return say("a ray beyond the grid has a span");
    if (Problem p = check_ray(grid, tile, r); !p.empty()) return say("ray ", r, " of its tile: ", p);
  }
  return {};
}

/// Every span of `after` within one of `before`.
Problem check_subset(const dexel::Tile& before, const dexel::Tile& after) {
  for (int r = 0; r < dexel::kTileRays; ++r) {
    const auto old = before.ray(r);
    std::size_t k = 0;
    for (const dexel::Span& s : after.ray(r)) {
      while (k < old.size() && old[k].far < s.far) ++k;
      if (k == old.size() || old[k].near > s.near)
        return say("ray ", r, " of its tile: ", s.near, " … ", s.far, " has material that was not there before");
    }
  }
  return {};
}

}  // namespace

Problem check_spans(const Volume& volume, const Volume* before) {
  for (std::size_t g = 0; g < volume.grids().size(); ++g) {
    const dexel::Grid& grid = volume.grids()[g];
    for (std::size_t t = 0; t < grid.tile_count(); ++t) {
      if (before && before->grids()[g].shared_tile(t) == grid.shared_tile(t)) continue;
      Problem p = check_tile(grid, t);
      if (p.empty() && before) p = check_subset(before->grids()[g].tile(t), grid.tile(t));
      if (!p.empty()) return say("direction ", "xyz"[static_cast<int>(grid.axis())], ", tile ", t, ": ", p);
    }
  }
  return {};
}

Problem check_removed(const Volume& before, const Volume& after, const sweep::Cut& cut) {
  double removed = 0;
  for (std::size_t m = 0; m < cut.removed.size(); ++m) {
    if (!std::isfinite(cut.removed[m]) || cut.removed[m] < 0) return say("removed ", cut.removed[m], " mm³");
    if (!geom::finite(cut.force[m]) || !geom::finite(cut.torque[m])) return say("force or torque is not finite");
    removed += cut.removed[m];
  }
  for (std::size_t g = 0; g < after.grids().size(); ++g)
    if (after.grids()[g].volume() > before.grids()[g].volume()) return say("the volume grew");
  // Spans are differences of coordinates: their lengths have the coordinates' rounding.
  const Box3& box = after.frame().box;
  const double size = glm::length(box.size()), most = glm::length(glm::max(glm::abs(box.lower), glm::abs(box.upper)));
  const double rounding = (1e-12 * size + 4e-16 * most) * size * size;
  const double lost = before.volume() - after.volume();
  if (std::abs(removed - lost) > rounding) return say("removed ", removed, " mm³, but the volume lost ", lost);
  return {};
}

Problem check_same_bytes(const Volume& a, const Volume& b) {
  for (std::size_t g = 0; g < a.grids().size(); ++g)
    for (std::size_t t = 0; t < a.grids()[g].tile_count(); ++t) {
      const dexel::Tile &x = a.grids()[g].tile(t), &y = b.grids()[g].tile(t);
      if (x.offset != y.offset || x.spans != y.spans || x.normals != y.normals)
        return say("direction ", "xyz"[static_cast<int>(a.grids()[g].axis())], ", tile ", t, " differs");
    }
  return {};
}

bool out_of_reach(const Stage& stage, const Move& move) {
  const double reach = geom::hypot(stage.tool.length(), stage.tool.profile().max_radius());
  Box3 tips;
  tips.add(move.from.tip), tips.add(move.to.tip);
  return !tips.grown(1.001 * reach).overlaps(stage.frame.box);
}

Allowed allowed_error(const Stage& stage, const Move& move) {
  const Box3& box = stage.frame.box;
  const double most =
      std::max({glm::length(box.lower), glm::length(box.upper), glm::length(move.from.tip), glm::length(move.to.tip)});
  const double way = glm::length(move.to.tip - move.from.tip), radius = stage.tool.profile().max_radius();
  // Rays are 6e-10 pitches off their places; the rest is rounding of sizes, of coordinates and along the move.
  const double rounding = 3e-9 * (radius + stage.frame.pitch) + 1.5e-14 * most + 3e-11 * way;
  double hollow = 0, apex = 0;
  Vec2 start{0, 0};
  for (const tool::ProfileSegment& s : stage.tool.profile().segments()) {
    // Two roots fall together where a ray meets the line that a cone's apex sweeps (sweep/straight_part.cpp).
    if (!s.centre && start.x == 0 && s.to.y > start.y) apex = 1e-7 * (s.to.y - start.y);
    if (s.centre && start.x + s.to.x < 2 * s.centre->x) hollow = tool::Profile::kConcaveTolerance;
    start = s.to;
  }
  const bool turns = Motion(move.from, move.to).angle() > 0;
  return {rounding + apex + hollow + (turns ? move.tolerance : 0), turns && hollow == 0, hollow,
          turns || hollow > 0.01 * radius};
}

}  // namespace riffler::stress
