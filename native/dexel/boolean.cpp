// Every ray is a linear merge of two sorted lists of ends. The work grows with the number of *distinct* pairs of tiles:
// the inner tiles of a block are one shared tile, and the result for a pair of tiles applies everywhere that pair
// occurs.
#include "riffler/dexel/boolean.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "dexel/joiner.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::dexel {

namespace {

using TilePtr = std::shared_ptr<const Tile>;

/// The exactly opposite direction: on the octahedron's unfolded square, −n is (−u, −v) folded to the other half.
PackedNormal opposite(const PackedNormal& n) {
  const int u = n.u, v = n.v;
  const int fu = 32767 - (v < 0 ? -v : v), fv = 32767 - (u < 0 ? -u : u);
  return {static_cast<std::int16_t>(u > 0 ? -fu : fu), static_cast<std::int16_t>(v > 0 ? -fv : fv)};
}

bool inside(Boolean op, bool a, bool b) {
  switch (op) {
    case Boolean::Subtract:
      return a && !b;
    case Boolean::Add:
      return a || b;
    default:
      return a && b;
  }
}

/// The ends of one operand's ray in order: end 2k is the near end of span k, end 2k + 1 its far end.
class Ends {
 public:
  Ends(std::span<const Span> spans, std::span<const SpanNormals> normals) : spans_(spans), normals_(normals) {}

  bool done() const { return next_ == 2 * spans_.size(); }
  double coordinate() const {
    if (done()) return std::numeric_limits<double>::infinity();
    const Span& span = spans_[next_ / 2];
    return next_ % 2 == 0 ? span.near : span.far;
  }
  bool inside() const { return next_ % 2 == 1; }
  /// Advances past all ends up to x. Returns whether that changed inside().
  bool pass(double x) {
    const bool before = inside();
    while (!done() && coordinate() <= x) ++next_;
    return inside() != before;
  }
  /// Normal at the last end passed.
  PackedNormal normal() const {
    if (normals_.empty()) return {};
    const SpanNormals& n = normals_[(next_ - 1) / 2];
    return next_ % 2 == 1 ? n.near : n.far;
  }

 private:
  std::span<const Span> spans_;
  std::span<const SpanNormals> normals_;
  std::size_t next_ = 0;
};

/// Merges the ends. If both operands have an end at the same place, a's normal stays.
void merge(Boolean op, Ends a, Ends b, Joiner out) {
  bool was = false;
  while (!a.done() || !b.done()) {
    const double x = std::min(a.coordinate(), b.coordinate());
    const bool by_a = a.pass(x);
    b.pass(x);
    const bool is = inside(op, a.inside(), b.inside());
    if (is == was) continue;
    was = is;
    const PackedNormal normal = by_a ? a.normal() : op == Boolean::Subtract ? opposite(b.normal()) : b.normal();
    if (is)
      out.open(x, normal);
    else
      out.close(x, normal);
  }
  out.flush();
}

/// Applies one operation to one grid: short cuts where possible, merges otherwise.
class TileOperation {
 public:
  TileOperation(Boolean op, const Grid& grid)
      : op_(op), grid_(grid), empty_(TileBuilder(grid.has_normals()).finish()) {}

  /// Returns the new tile, or `a` itself if nothing changes. `rays`: number of the tile's rays that lie on the grid.
  TilePtr run(const TilePtr& a, const TilePtr& b, std::size_t rays, TileBuilder& builder) const {
    if (TilePtr known = short_cut(a, b, rays)) return known;
    const double least = kSliver * grid_.pitch();
    for (int r = 0; r < kTileRays; ++r) {
      merge(op_, {a->ray(r), a->ray_normals(r)}, {b->ray(r), b->ray_normals(r)}, {builder, least});
      builder.next_ray();
    }
    TilePtr merged = builder.finish();
    return same_material(*merged, *a) ? a : merged;
  }

 private:
  /// The result if it needs no merge, otherwise null.
  TilePtr short_cut(const TilePtr& a, const TilePtr& b, std::size_t rays) const {
    const bool apart = a->spans.empty() || b->spans.empty() || a->reach.cut(b->reach).empty();
    switch (op_) {
      case Boolean::Subtract:
        if (apart) return a;
        return a == b || full(*b, rays) ? empty_ : nullptr;
      case Boolean::Add:
        if (b->spans.empty() || a == b || full(*a, rays)) return a;
        return a->spans.empty() || full(*b, rays) ? b : nullptr;
      default:
        if (a->spans.empty() || a == b) return a;
        if (apart) return empty_;
        return full(*b, rays) ? a : full(*a, rays) ? b : nullptr;
    }
  }

  /// Whether every ray of the tile on the grid is one span over the whole box; most other tiles fail at once.
  bool full(const Tile& tile, std::size_t rays) const {
    const Span whole{grid_.box().lower.z, grid_.box().upper.z};
    if (tile.spans.size() != rays || tile.spans.front() != whole) return false;
    for (const Span& span : tile.spans)
      if (span != whole) return false;
    return true;  // as many full spans as rays, and no ray can hold two
  }

  Boolean op_;
  const Grid& grid_;
  TilePtr empty_;
};

std::size_t rays_on_grid(const Grid& grid, int tu, int tv) {
  const int rows = std::min(kTileSide, grid.nu() - tu * kTileSide);
  const int columns = std::min(kTileSide, grid.nv() - tv * kTileSide);
  return static_cast<std::size_t>(rows) * columns;
}

/// A pair of tiles at one or more places, the number of their rays on the grid there (a border tile and an inner one
/// may be the same tile), and its result.
struct Pair {
  TilePtr a, b;
  std::size_t rays;
  TilePtr result;
};

using PairKey = std::tuple<const Tile*, const Tile*, std::size_t>;

struct PairHash {
  std::size_t operator()(const PairKey& key) const {
    const std::hash<const Tile*> hash;
    return (hash(std::get<0>(key)) * 31 + hash(std::get<1>(key))) * 31 + std::get<2>(key);
  }
};

/// The distinct pairs of two grids and, for each tile, the index of its pair.
struct Pairs {
  std::vector<Pair> pairs;
  std::vector<std::uint32_t> at;

  Pairs(const Grid& a, const Grid& b) {
    std::unordered_map<PairKey, std::uint32_t, PairHash> known;
    at.reserve(a.tile_count());
    for (int tu = 0; tu < a.tiles_u(); ++tu)
      for (int tv = 0; tv < a.tiles_v(); ++tv) {
        const std::size_t t = a.tile_index(tu, tv), rays = rays_on_grid(a, tu, tv);
        const auto [found, added] =
            known.try_emplace(PairKey(&a.tile(t), &b.tile(t), rays), static_cast<std::uint32_t>(pairs.size()));
        if (added) pairs.push_back({a.shared_tile(t), b.shared_tile(t), rays, nullptr});
        at.push_back(found->second);
      }
  }
};

}  // namespace

void check_same_grid(const Frame& frame, const Frame& other, const std::string& what) {
  if (frame == other) return;
  const char* differs = frame.directions != other.directions ? "directions"
                        : frame.pitch != other.pitch         ? "pitch"
                        : frame.box.lower != other.box.lower ? "lower"
                                                             : "upper";
  throw std::invalid_argument(what + " must have the same grid as the volume, but its " + differs + " differs");
}

std::shared_ptr<const Tile> apply(Boolean op, const Grid& grid, std::size_t tile, const TilePtr& a, const TilePtr& b,
                                  TileBuilder& builder) {
  const int k = static_cast<int>(tile);
  const std::size_t rays = rays_on_grid(grid, k / grid.tiles_v(), k % grid.tiles_v());
  return TileOperation(op, grid).run(a, b, rays, builder);
}

void apply(Boolean op, Volume& a, const Volume& b, const Progress& progress) {
  check_same_grid(a.frame(), b.frame(), "the other volume");
  std::vector<Pairs> work;
  std::vector<TileOperation> operations;
  std::vector<std::pair<std::size_t, std::size_t>> jobs;  // (grid, pair)
  for (std::size_t g = 0; g < a.grids().size(); ++g) {
    work.emplace_back(a.grids()[g], b.grids()[g]);
    operations.emplace_back(op, a.grids()[g]);
    for (std::size_t p = 0; p < work[g].pairs.size(); ++p) jobs.emplace_back(g, p);
  }

  constexpr std::size_t grain = 16;
  base::parallel_for(
      jobs.size(), grain,
      [&](std::size_t begin, std::size_t end) {
        TileBuilder builder(a.grids().front().has_normals());
        for (std::size_t k = begin; k < end; ++k) {
          const auto [g, p] = jobs[k];
          Pair& pair = work[g].pairs[p];
          pair.result = operations[g].run(pair.a, pair.b, pair.rays, builder);
        }
      },
      progress);

  // Nothing below throws: the volume changes as a whole or not at all.
  Stats stats;
  for (std::size_t g = 0; g < work.size(); ++g)
    for (std::size_t t = 0; t < work[g].at.size(); ++t) {
      const Pair& pair = work[g].pairs[work[g].at[t]];
      if (pair.result == pair.a) continue;
      a.grids()[g].set_tile(t, pair.result);
      ++stats.tiles_changed;
    }
  stats.tiles_visited = jobs.size();
  a.count(stats);
  if (stats.tiles_changed > 0) a.touch();
}

}  // namespace riffler::dexel
