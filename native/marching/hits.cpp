#include "marching/hits.hpp"

#include <algorithm>
#include <limits>
#include <span>

#include "geom/parallel.hpp"

namespace riffler::marching {

namespace {

constexpr double kReach = 0.5;  // how far outside its edge an end may lie, pitches

double place_of(const Span& s, bool far) {
  return far ? s.far : s.near;
}

/// The end of one kind nearest to [low, high], within `reach` of it; of several inside, the one next to the edge's
/// inside end: the low one for far ends. −1 if there is none.
int nearest_end(std::span<const Span> spans, double low, double high, double reach, bool far) {
  const int n = static_cast<int>(spans.size());
  int above = 0;  // first end ≥ low (far), or > high (near)
  const double bound = far ? low : std::nextafter(high, std::numeric_limits<double>::infinity());
  if (n > 8)
    above = static_cast<int>(
        std::partition_point(spans.begin(), spans.end(), [&](const Span& s) { return place_of(s, far) < bound; }) -
        spans.begin());
  else
    while (above < n && place_of(spans[above], far) < bound) ++above;
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

/// Reads hits off the rays that run along one lattice axis.
class AxisHits {
 public:
  AxisHits(const Grid* grid, const Lattice& lattice, int axis) : grid_(grid), lattice_(lattice), axis_(axis) {}

  Hit operator()(const LatticeEdge& edge) {
    if (!grid_) return axis_hit(0.5, edge, false);
    const auto [u, v] = ray_of(edge);
    const std::span<const Span> spans = grid_->ray(u, v);
    const int index = axis_ == 0 ? edge.i : axis_ == 1 ? edge.j : edge.k;
    const double low = lattice_.at(axis_, index), high = lattice_.at(axis_, index + 1), h = lattice_.pitch();
    const int n = nearest_end(spans, low, high, kReach * h, !edge.rising);
    if (n < 0) return axis_hit(0.5, edge, true);
    const double t = (place_of(spans[n], !edge.rising) - low) / h;
    if (!grid_->has_normals()) return axis_hit(t, edge, false);
    const SpanNormals& normals = grid_->ray_normals(u, v)[n];
    const PackedNormal packed = edge.rising ? normals.near : normals.far;
    if (packed != last_packed_) last_packed_ = packed, last_ = packed.unpack();  // flat faces have one for all
    const Vec3& normal = last_;
    if ((edge.rising ? -normal[axis_] : normal[axis_]) <= 0) return axis_hit(std::clamp(t, 0.0, 1.0), edge, true);
    return {static_cast<float>(t),
            {static_cast<float>(normal.x), static_cast<float>(normal.y), static_cast<float>(normal.z)}};
  }

 private:
  /// Indices of the ray in its grid's cyclic frame. (A grid of one direction stands along the lattice's third axis.)
  std::array<int, 2> ray_of(const LatticeEdge& edge) const {
    switch (axis_) {
      case 0:
        return {edge.j - 1, edge.k - 1};
      case 1:
        return {edge.k - 1, edge.i - 1};
      default:
        return {edge.i - 1, edge.j - 1};
    }
  }

  const Grid* grid_;
  const Lattice& lattice_;
  int axis_;
  PackedNormal last_packed_{};
  Vec3 last_ = PackedNormal{}.unpack();
};

}  // namespace

std::vector<Hit> hits_of(const Volume& volume, const Lattice& lattice, const SignField& signs, const Counts& counts,
                         const Progress& progress) {
  const bool three = volume.grids().size() == 3;
  const AxisHits hits_along[3] = {{three ? volume.grid(Axis::X) : nullptr, lattice, 0},
                                  {three ? volume.grid(Axis::Y) : nullptr, lattice, 1},
                                  {&volume.reference(), lattice, 2}};
  std::vector<Hit> hits(counts.edges());
  parallel_for(
      static_cast<std::size_t>(lattice.cells(0)), 4,
      [&](std::size_t begin, std::size_t end) {
        AxisHits along[3] = {hits_along[0], hits_along[1], hits_along[2]};
        for (int i = static_cast<int>(begin); i < static_cast<int>(end); ++i) {
          Hit* out = hits.data() + counts.edge(i, 0, 0);
          for (int j = 0; j < lattice.cells(1); ++j)
            for (int axis = 0; axis < 3; ++axis)
              for (int w = 0; w < signs.words(); ++w) {
                const std::uint64_t inside = signs.column(i, j)[w];
                for (std::uint64_t word = crossed_edges(signs, i, j, axis, w); word; word &= word - 1) {
                  const int b = std::countr_zero(word);
                  *out++ = along[axis]({axis, i, j, 64 * w + b, !(inside >> b & 1)});
                }
              }
        }
      },
      progress);
  return hits;
}

}  // namespace riffler::marching
