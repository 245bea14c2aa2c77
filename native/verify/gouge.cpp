#include "verify/gouge.hpp"

#include <algorithm>
#include <optional>

#include "riffler/dexel/from_mesh/from_mesh.hpp"

namespace riffler::verify {

namespace {

/// Whether the piece [near, far] of a part's span begins at the part's surface and is no longer than the tolerance, so
/// that no point of it is deep. Ends in the box's own faces may lie within a part that extends beyond the box.
bool surely_shallow(const dexel::Grid& grid, const dexel::Span& span, double near, double far, double tolerance) {
  const bool at_surface =
      (near == span.near && near > grid.box().lower.z) || (far == span.far && far < grid.box().upper.z);
  return at_surface && far - near <= tolerance;
}

/// The part's material of a tile on the rays that lost some of it deep inside, as far as it was still present before.
std::shared_ptr<const dexel::Tile> deep_rays(const PartSurface& surface, const dexel::Grid& grid, const Slab& slab,
                                             std::size_t k, const dexel::Tile& part, const dexel::Tile& before,
                                             const dexel::Tile& after) {
  std::optional<dexel::TileBuilder> builder;
  for (int r = 0; r < dexel::kTileRays; ++r) {
    bool any = false;
    if (!part.ray(r).empty() && !before.ray(r).empty())
      for_each_loss_on_ray(before.ray(r), after.ray(r), [&](double near, double far) {
        for (const dexel::Span& s : part.ray(r)) {
          const double a = std::max(near, s.near), b = std::min(far, s.far);
          if (any || !(a < b) || surely_shallow(grid, s, a, b, surface.tolerance())) continue;
          any = surface.deep(on_ray(grid, slab, k, r, a), on_ray(grid, slab, k, r, b));
        }
      });
    if (any && !builder) {
      builder.emplace(grid.has_normals());
      while (builder->rays() < r) builder->next_ray();
    }
    if (any)
      for (const dexel::Span& s : part.ray(r))
        for (const dexel::Span& b : before.ray(r))
          if (std::max(s.near, b.near) < std::min(s.far, b.far))
            builder->add({std::max(s.near, b.near), std::min(s.far, b.far)});
    if (builder) builder->next_ray();
  }
  return builder ? builder->finish() : nullptr;
}

/// mm: shorter pieces are rounding. A retract along the path of its plunge would gouge what the plunge gouged, by 1e-15
/// mm. Not larger, since many small bites make a deep gouge.
constexpr double kBite = 1e-6;

/// The deepest place at which a slab of the part lost material.
PartSurface::Deepest deepest_loss(const PartSurface& surface, const Workbench& bench, const SlabTiles& before,
                                  const SlabTiles& after) {
  PartSurface::Deepest worst;
  for (std::size_t k = 0; k < before.size(); ++k) {
    if (before[k] == after[k]) continue;
    for_each_loss(*before[k], *after[k], [&](int r, double near, double far) {
      if (far - near < kBite) return;
      const Vec3 a = on_ray(bench.grid(), bench.slab(), k, r, near), b = on_ray(bench.grid(), bench.slab(), k, r, far);
      surface.look_deeper(a, b, worst);
    });
  }
  return worst;
}

}  // namespace

Target::Target(const Mesh& part, const dexel::Frame& frame, double tolerance, const Progress& progress)
    : volume_(dexel::from_mesh(part, frame, progress)), surface_(part, tolerance), bounds_(mesh::bounds(part)) {}

PartSurface::PartSurface(const Mesh& part, double tolerance) : closest_(part, true), tolerance_(tolerance) {}

bool PartSurface::deep(const Vec3& near, const Vec3& far) const {
  const Vec3 middle = (near + far) / 2.0;
  if (!closest_.within(middle, tolerance_)) return true;
  const double half = glm::length(far - near) / 2, depth = closest_(middle).distance;
  // The distance changes by at most the length along the ray.
  if (depth + half <= tolerance_) return false;
  if (half < 0.01 * tolerance_) return true;
  return deep(near, middle) || deep(middle, far);
}

void PartSurface::look_deeper(const Vec3& near, const Vec3& far, Deepest& worst) const {
  // No point of a piece is deeper than its middle by more than half its length (the distance is 1-Lipschitz).
  const auto shallower = [&](const Vec3& middle, double half, double than) {
    return than > half && closest_.within(middle, than - half);
  };
  const auto look = [&](const Vec3& p) {
    const double d = closest_(p).distance;
    if (d > worst.depth) worst = {d, p};
  };
  constexpr double kRounding = 1 + 1e-9;  // rays that end on one plane are equally deep
  if (shallower((near + far) / 2.0, glm::length(far - near) / 2, kRounding * worst.depth)) return;
  look(near), look(far);
  struct RayPiece {
    Vec3 a, b;
  };
  std::vector<RayPiece> pieces{{near, far}};
  while (!pieces.empty()) {
    const RayPiece p = pieces.back();
    pieces.pop_back();
    const Vec3 middle = (p.a + p.b) / 2.0;
    if (shallower(middle, glm::length(p.b - p.a) / 2, std::max(1.01 * worst.depth, tolerance_))) continue;
    look(middle);
    pieces.push_back({p.a, middle}), pieces.push_back({middle, p.b});
  }
}

void find_gouges(const PartSurface& surface, const SlabTiles& part, Workbench& bench, const SlabTiles& before,
                 const SlabTiles& after, const Moves& moves, std::span<const std::size_t> cuts,
                 std::vector<Event>& events) {
  SlabTiles deep(before.size(), base::make_shared_block<const dexel::Tile>());
  bool any = false;
  for (std::size_t k = 0; k < before.size(); ++k) {
    if (before[k] == after[k]) continue;
    const dexel::Tile& tile = *part[k];
    if (tile.spans.empty() || tile.reach.cut(before[k]->reach).empty()) continue;
    if (auto spans = deep_rays(surface, bench.grid(), bench.slab(), k, tile, *before[k], *after[k]))
      deep[k] = std::move(spans), any = true;
  }
  if (!any) return;
  const Box3 box = material_box(bench.grid(), bench.slab(), deep);
  for (const std::size_t i : cuts) {
    if (!(moves.touch(i, box) & Moves::Cutter)) continue;
    SlabTiles left = bench.after(deep, moves.shapes(i).cutter, moves.from(i), moves.to(i));
    if (left == deep) continue;
    const PartSurface::Deepest worst = deepest_loss(surface, bench, deep, left);
    deep = std::move(left);
    if (worst.depth > surface.tolerance())
      events.push_back({Kind::Gouge, Member::Cutter, -1, moves.row(i), worst.depth, worst.depth, worst.point});
  }
}

void find_missing(const Target& target, const dexel::Grid& grid, const Slab& slab, const SlabTiles& stock,
                  std::vector<Event>& events) {
  const PartSurface& surface = target.surface();
  const SlabTiles part = target.tiles(slab);
  PartSurface::Deepest worst;
  for (std::size_t k = 0; k < stock.size(); ++k) {
    const dexel::Tile& tile = *part[k];
    if (tile.spans.empty()) continue;
    for (int r = 0; r < dexel::kTileRays; ++r)
      for (const dexel::Span& s : tile.ray(r))
        for_each_loss_on_ray({&s, 1}, stock[k]->ray(r), [&](double near, double far) {
          if (surely_shallow(grid, s, near, far, surface.tolerance())) return;
          const Vec3 a = on_ray(grid, slab, k, r, near), b = on_ray(grid, slab, k, r, far);
          if (!surface.deep(a, b)) return;
          surface.look_deeper(a, b, worst);
        });
  }
  if (worst.depth > surface.tolerance())
    events.push_back({Kind::Gouge, Member::Cutter, -1, 0, worst.depth, worst.depth, worst.point});
}

}  // namespace riffler::verify
