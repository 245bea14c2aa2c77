#include "marching/hits.hpp"

#include <algorithm>
#include <limits>
#include <span>

namespace riffler::marching {

namespace {

// How far outside its edge an end may lie, in pitches. A floor that only one direction keeps may lie beyond the last
// point of its ray: half a pitch, and half a pitch more where the box ends.
constexpr double kReach = 0.5, kReachOfFloor = 1;

double place_of(const dexel::Span& s, bool far) {
  return far ? s.far : s.near;
}

/// The end of one kind nearest to [low, high], within `reach` of it. If several are inside, the one nearest to the
/// edge's inside end, which is the low one for far ends. −1 if there is none.
int nearest_end(std::span<const dexel::Span> spans, double low, double high, double reach, bool far) {
  const int n = static_cast<int>(spans.size());
  int above = 0;  // first end ≥ low (far), or > high (near)
  const auto before = [&](const dexel::Span& s) { return far ? s.far < low : s.near <= high; };
  if (n > 8)
    above = static_cast<int>(std::partition_point(spans.begin(), spans.end(), before) - spans.begin());
  else
    while (above < n && before(spans[above])) ++above;
  const int below = above - 1;
  if (far && above < n && spans[above].far <= high) return above;
  if (!far && below >= 0 && spans[below].near >= low) return below;
  const double infinity = std::numeric_limits<double>::infinity();
  const double gap_below = below >= 0 ? low - place_of(spans[below], far) : infinity;
  const double gap_above = above < n ? place_of(spans[above], far) - high : infinity;
  if (std::min(gap_below, gap_above) > reach) return -1;
  return gap_below <= gap_above ? below : above;
}

Hit axis_hit(double t, const LatticeEdge& edge, bool weak) {
  Hit hit{static_cast<float>(t) - (weak ? Hit::kWeak : 0), {0, 0, 0}};
  hit.normal[edge.axis] = edge.rising ? -1.0F : 1.0F;
  return hit;
}

}  // namespace

HitFinder::HitFinder(const Volume& volume, const Lattice& lattice)
    : lattice_(&lattice), grids_{nullptr, nullptr, &volume.reference()} {
  if (volume.grids().size() == 3) grids_[0] = volume.grid(Axis::X), grids_[1] = volume.grid(Axis::Y);
}

Hit HitFinder::operator()(const LatticeEdge& edge) {
  const dexel::Grid* const grid = grids_[edge.axis];
  if (!grid) return axis_hit(0.5, edge, false);
  // Indices of the ray in its grid's cyclic frame. (A grid of one direction lies along the lattice's third axis.)
  const int place[5] = {edge.i, edge.j, edge.k, edge.i, edge.j};
  const int u = place[edge.axis + 1] - 1, v = place[edge.axis + 2] - 1;
  const dexel::Tile& tile = grid->tile(grid->tile_index(u / dexel::kTileSide, v / dexel::kTileSide));
  const int ray = dexel::Grid::ray_index(u, v);
  const std::span<const dexel::Span> spans = tile.ray(ray);
  const double low = lattice_->at(edge.axis, place[edge.axis]), high = lattice_->at(edge.axis, place[edge.axis] + 1),
               h = lattice_->pitch();
  const int n = nearest_end(spans, low, high, (grid->has_normals() ? kReach : kReachOfFloor) * h, !edge.rising);
  if (n < 0) return axis_hit(0.5, edge, true);
  const double t = (place_of(spans[n], !edge.rising) - low) / h;
  if (!grid->has_normals()) return axis_hit(std::clamp(t, -kReach, 1 + kReach), edge, false);
  const dexel::SpanNormals& normals = tile.ray_normals(ray)[n];
  const dexel::PackedNormal packed = edge.rising ? normals.near : normals.far;
  // A flat face has one normal for all its hits.
  if (packed != last_packed_) last_packed_ = packed, last_ = packed.unpack();
  const double along = (&last_.x)[edge.axis];
  if ((edge.rising ? -along : along) <= 0) return axis_hit(std::clamp(t, 0.0, 1.0), edge, true);
  return {static_cast<float>(t),
          {static_cast<float>(last_.x), static_cast<float>(last_.y), static_cast<float>(last_.z)}};
}

}  // namespace riffler::marching
