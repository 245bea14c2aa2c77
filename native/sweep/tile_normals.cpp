#include "sweep/tile_normals.hpp"

#include <algorithm>
#include <vector>

#include "sweep/hull_normals.hpp"
#include "sweep/kernels.hpp"
#include "sweep/swept_normals.hpp"

namespace riffler::sweep {

namespace {

/// An end whose normal is to be stored.
struct Unresolved {
  std::size_t step;
  double u, v, s, t;
  double* origin;
  dexel::PackedNormal* normal;
};

/// Scratch memory. A thread has one, so packing does not allocate again and again.
struct NormalScratch {
  base::BlockVector<Unresolved> found, sorted;
  base::BlockVector<std::uint32_t> starts;
  SweptEnds ends;

  /// For the first use: as much as a rough tile needs, so that a pen's step seldom has to ask for more.
  void reserve() {
    constexpr std::size_t kEnds = 4 * dexel::kTileRays;
    found.reserve(kEnds), sorted.reserve(kEnds), starts.reserve(kEnds);
    ends.reserve(kEnds);
  }
};

/// Sorts by step with a counting sort: a tile has many ends of few steps.
void sort_by_step(NormalScratch& scratch) {
  auto& found = scratch.found;
  const auto [first, last] =
      std::minmax_element(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.step < b.step; });
  const std::size_t low = first->step, count = last->step - low + 1;
  scratch.starts.assign(count + 1, 0);
  for (const Unresolved& end : found) ++scratch.starts[end.step - low + 1];
  for (std::size_t k = 0; k < count; ++k) scratch.starts[k + 1] += scratch.starts[k];
  scratch.sorted.resize(found.size());
  for (const Unresolved& end : found) scratch.sorted[scratch.starts[end.step - low]++] = end;
}

dexel::PackedNormal packed(double u, double v) {
  const auto quantise = [](double x) {
    const double scaled = std::min(std::max(x, -1.0), 1.0) * 32767;
    return static_cast<std::int16_t>(scaled + (scaled < 0 ? -0.5 : 0.5));
  };
  return {quantise(u), quantise(v)};
}

}  // namespace

void store_normals(OpenTile& rays, const dexel::Grid& grid, std::size_t tile, std::span<const Step> steps) {
  thread_local NormalScratch scratch;
  const int row = static_cast<int>(tile) / grid.tiles_v() * dexel::kTileSide;
  const int column = static_cast<int>(tile) % grid.tiles_v() * dexel::kTileSide;
  scratch.reserve();
  scratch.found.clear();
  rays.each_unresolved([&](int r, double s, double& origin, dexel::PackedNormal& normal) {
    const auto step = static_cast<std::size_t>(origin / 2);
    scratch.found.push_back({step, grid.shifted_u(row + r / dexel::kTileSide),
                             grid.shifted_v(column + r % dexel::kTileSide), s, origin - 2 * static_cast<double>(step),
                             &origin, &normal});
  });
  if (scratch.found.empty()) return;
  sort_by_step(scratch);
  const auto& sorted = scratch.sorted;
  for (std::size_t begin = 0, end = 0; begin < sorted.size(); begin = end) {
    const std::size_t step = sorted[begin].step;
    scratch.ends.clear();
    for (; end < sorted.size() && sorted[end].step == step; ++end)
      scratch.ends.add(sorted[end].u, sorted[end].v, sorted[end].s, sorted[end].t);
    if (const auto* hull = std::get_if<HullPart>(&steps[step].body)) {
      hull_normals(*hull, grid.axis(), scratch.ends);
    } else {
      const SweptSurface surface(steps[step], grid.axis());
      scratch.ends.complete(surface, *steps[step].motion);
      compute_normals(surface, scratch.ends);
    }
    for (std::size_t k = begin; k < end; ++k) {
      *sorted[k].normal = packed(scratch.ends.map[0][k - begin], scratch.ends.map[1][k - begin]);
      *sorted[k].origin = Origins::kStored;
    }
  }
}

}  // namespace riffler::sweep
