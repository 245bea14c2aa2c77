// Union-find over all spans.
#include "riffler/dexel/parts.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <string>

namespace riffler::dexel {

namespace {

using Number = std::uint32_t;
constexpr Number kNone = ~Number{0};

/// Disjoint sets whose root is their smallest number, so that nothing depends on the order of the joins.
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), Number{0}); }
  Number root(Number k) {
    while (parent_[k] != k) k = parent_[k] = parent_[parent_[k]];
    return k;
  }
  void join(Number a, Number b) {
    a = root(a), b = root(b);
    (a < b ? parent_[b] : parent_[a]) = std::min(a, b);
  }

 private:
  std::vector<Number> parent_;
};

/// The number of each ray's first span.
class Numbers {
 public:
  Numbers(const Grid& grid, Number first) : nv_(grid.nv()), first_(static_cast<std::size_t>(grid.nu()) * nv_ + 1) {
    std::size_t k = 0;
    for (int i = 0; i < grid.nu(); ++i)
      for (int j = 0; j < nv_; ++j) {
        first_[k++] = first;
        first += static_cast<Number>(grid.ray(i, j).size());
      }
    first_[k] = first;
  }
  Number operator()(int i, int j) const { return first_[static_cast<std::size_t>(i) * nv_ + j]; }
  Number end() const { return first_.back(); }

 private:
  int nv_;
  std::vector<Number> first_;
};

/// Joins the spans of two rays where they overlap.
void join_overlapping(std::span<const Span> a, Number first_a, std::span<const Span> b, Number first_b, Sets& sets) {
  for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
    if (std::max(a[i].near, b[j].near) < std::min(a[i].far, b[j].far))
      sets.join(first_a + static_cast<Number>(i), first_b + static_cast<Number>(j));
    a[i].far < b[j].far ? ++i : ++j;
  }
}

void join_neighbours(const Grid& grid, const Numbers& numbers, Sets& sets) {
  for (int i = 0; i < grid.nu(); ++i)
    for (int j = 0; j < grid.nv(); ++j) {
      const std::span<const Span> ray = grid.ray(i, j);
      if (i + 1 < grid.nu()) join_overlapping(ray, numbers(i, j), grid.ray(i + 1, j), numbers(i + 1, j), sets);
      if (j + 1 < grid.nv()) join_overlapping(ray, numbers(i, j), grid.ray(i, j + 1), numbers(i, j + 1), sets);
    }
}

Number span_at(const Grid& grid, const Numbers& numbers, int i, int j, double z) {
  const std::span<const Span> ray = grid.ray(i, j);
  const auto next = std::upper_bound(ray.begin(), ray.end(), z, [](double x, const Span& s) { return x < s.near; });
  if (next == ray.begin() || z > std::prev(next)->far) return kNone;
  return numbers(i, j) + static_cast<Number>(std::prev(next) - ray.begin());
}

/// Joins each span of `grid` to the first span of `reference` that it meets. Other spans that it meets are connected to
/// that one already, unless the two directions disagree.
void join_across(const Grid& grid, const Numbers& numbers, const Grid& reference, const Numbers& reference_numbers,
                 Sets& sets) {
  const double h = grid.pitch();
  const int steps = static_cast<int>(std::lround(grid.box().size().z / h));
  for (int i = 0; i < grid.nu(); ++i)
    for (int j = 0; j < grid.nv(); ++j) {
      const std::span<const Span> ray = grid.ray(i, j);
      for (std::size_t s = 0; s < ray.size(); ++s) {
        const int begin = std::max(0, static_cast<int>(std::ceil((ray[s].near - grid.box().lower.z) / h - 0.5)));
        for (int k = begin; k < steps; ++k) {
          const double w = grid.box().lower.z + (k + 0.5) * h;
          if (w > ray[s].far) break;
          const Vec3 p = to_local(reference.axis(), to_world(grid.axis(), {grid.u(i), grid.v(j), w}));
          const int a = static_cast<int>((p.x - reference.box().lower.x) / h),
                    b = static_cast<int>((p.y - reference.box().lower.y) / h);
          if (a < 0 || b < 0 || a >= reference.nu() || b >= reference.nv()) continue;
          const Number met = span_at(reference, reference_numbers, a, b, p.z);
          if (met == kNone) continue;
          sets.join(numbers(i, j) + static_cast<Number>(s), met);
          break;
        }
      }
    }
}

std::size_t grid_index(const Volume& volume, const Grid& grid) {
  return static_cast<std::size_t>(&grid - volume.grids().data());
}

/// The number of pieces, and the piece of each span.
struct Pieces {
  std::size_t count = 0;
  std::vector<Number> of;
};

Pieces number_pieces(const Volume& volume, const std::vector<Numbers>& numbers, Sets& sets, double least) {
  const Grid& reference = volume.reference();
  const Numbers& first = numbers[grid_index(volume, reference)];
  const std::size_t spans = numbers.back().end();
  std::vector<double> volume_of(spans, -1);  // mm³ of each root that the reference direction sees
  for (int i = 0; i < reference.nu(); ++i)
    for (int j = 0; j < reference.nv(); ++j) {
      Number k = first(i, j);
      for (const Span& s : reference.ray(i, j)) {
        double& sum = volume_of[sets.root(k++)];
        sum = std::max(sum, 0.0) + s.length() * reference.area(i, j);
      }
    }
  std::vector<Number> order;
  for (Number k = 0; k < spans; ++k)
    if (volume_of[k] >= 0) order.push_back(k);
  std::stable_sort(order.begin(), order.end(), [&](Number a, Number b) { return volume_of[a] > volume_of[b]; });
  while (order.size() > 1 && volume_of[order.back()] < least) order.pop_back();
  if (order.size() > kMaxParts)
    throw std::invalid_argument("the volume has " + std::to_string(order.size()) + " pieces, more than " +
                                std::to_string(kMaxParts) + "; set least (mm³) to keep only larger ones");
  std::vector<Number> piece(spans, 0);
  for (std::size_t k = 0; k < order.size(); ++k) piece[order[k]] = static_cast<Number>(k);
  Pieces out{order.size(), std::vector<Number>(spans)};
  for (Number k = 0; k < spans; ++k) out.of[k] = piece[sets.root(k)];
  if (out.count == 0 && spans > 0) out.count = 1;
  return out;
}

/// Makes one volume per piece. Tiles that belong to one piece alone stay shared with the original.
std::vector<Volume> split(const Volume& volume, const std::vector<Numbers>& numbers, const Pieces& pieces,
                          const Progress& progress) {
  std::vector<Volume> out(pieces.count, Volume(volume.frame()));
  for (std::size_t g = 0; g < volume.grids().size(); ++g) {
    const Grid& grid = volume.grids()[g];
    for (std::size_t t = 0; t < grid.tile_count(); ++t) {
      const int i0 = static_cast<int>(t) / grid.tiles_v() * kTileSide,
                j0 = static_cast<int>(t) % grid.tiles_v() * kTileSide;
      std::vector<Number> here;
      for (int i = i0; i < std::min(i0 + kTileSide, grid.nu()); ++i)
        for (int j = j0; j < std::min(j0 + kTileSide, grid.nv()); ++j)
          for (std::size_t s = 0; s < grid.ray(i, j).size(); ++s) {
            const Number piece = pieces.of[numbers[g](i, j) + s];
            if (std::find(here.begin(), here.end(), piece) == here.end()) here.push_back(piece);
          }
      for (const Number piece : here) {
        Grid& target = out[piece].grids()[g];
        if (here.size() == 1) {
          target.set_tile(t, grid.shared_tile(t));
          continue;
        }
        target.fill_tile(t, [&](int i, int j, TileBuilder& builder) {
          const std::span<const Span> ray = grid.ray(i, j);
          const std::span<const SpanNormals> normals = grid.ray_normals(i, j);
          for (std::size_t s = 0; s < ray.size(); ++s)
            if (pieces.of[numbers[g](i, j) + s] == piece)
              builder.add(ray[s], normals.empty() ? SpanNormals{} : normals[s]);
        });
      }
    }
    base::report(progress, 0.6 + 0.4 * static_cast<double>(g + 1) / static_cast<double>(volume.grids().size()));
  }
  return out;
}

}  // namespace

std::vector<Volume> parts(const Volume& volume, double least, const Progress& progress) {
  if (!std::isfinite(least) || least < 0) throw std::invalid_argument("least must be a volume in mm³");
  std::vector<Numbers> numbers;
  for (const Grid& grid : volume.grids()) numbers.emplace_back(grid, numbers.empty() ? 0 : numbers.back().end());
  Sets sets(numbers.back().end());
  const std::size_t reference = grid_index(volume, volume.reference());
  for (std::size_t g = 0; g < numbers.size(); ++g) {
    join_neighbours(volume.grids()[g], numbers[g], sets);
    if (g != reference) join_across(volume.grids()[g], numbers[g], volume.reference(), numbers[reference], sets);
    base::report(progress, 0.6 * static_cast<double>(g + 1) / static_cast<double>(numbers.size()));
  }
  return split(volume, numbers, number_pieces(volume, numbers, sets, least), progress);
}

}  // namespace riffler::dexel
