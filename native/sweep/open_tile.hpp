// A tile during cuts: unpacked, so that the kernels can cut every ray with at most two spans.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>
#include <memory>

#include "base/lanes.hpp"
#include "riffler/base/block_pool.hpp"
#include "riffler/dexel/grid.hpp"
#include "riffler/geom/interval.hpp"
#include "sweep/piece_pool.hpp"

namespace riffler::sweep {

/// The arrays of an OpenTile, for the kernels. Each has room for `kLanes` more rays.
struct RayPlanes {
  dexel::Span *first, *last;
  dexel::Span* hull;                      // of the rays in `many`
  Origins *first_origins, *last_origins;  // null if the grid stores no normals
  dexel::SpanNormals *first_normals, *last_normals;
  std::uint32_t *two, *many, *pending;
};

/// A ray has its only span, or the first of two, in the plane `first`, and the second in the plane `last`, with a bit
/// in `two`. If there are more, those at both sides of the gap where the tool was last are in the planes, and the
/// others in a pool, with a bit in `many`, too. An empty ray has near > far in `first`, so no cut touches it. A tile
/// with one span in each ray is read in place until something of it is cut: a tool passes over most tiles without
/// removing anything.
class OpenTile {
 public:
  OpenTile() = default;
  OpenTile(const OpenTile&) = delete;
  OpenTile& operator=(const OpenTile&) = delete;

  /// Remaining spans thinner than this (mm) vanish.
  static double thinnest(const dexel::Grid& grid) { return 1e-9 * grid.pitch(); }

  /// Begins with tile number `tile` of the grid. If it throws, no tile is open.
  void begin(const dexel::Grid& grid, std::size_t tile);
  /// The tile that it began with, or that it was packed into.
  const std::shared_ptr<const dexel::Tile>& source() const { return source_; }
  /// Whether something was cut since then.
  bool changed() const { return changed_; }
  /// Forgets the tile.
  void end() { source_.reset(), changed_ = false; }

  /// The plane `first`, for reading.
  const dexel::Span* first() const { return planes_.first ? planes_.first : source_->spans.data(); }
  const RayPlanes& planes() const { return planes_; }
  /// The planes, for writing.
  const RayPlanes& open();
  /// Asks for memory, as much as a tile mostly needs.
  void reserve(bool with_normals);

  /// Removes [cut.near, cut.far] from ray r. New ends have these origins: `near` at cut.far, `far` at cut.near.
  /// `removed(near, far)` is called for every piece of material removed. Returns whether there was any.
  template <class Removed>
  bool subtract(int r, const Interval& cut, const Origins& origins, const Removed& removed) {
    kept_.clear();
    bool any = false;
    open_planes();
    each(r, [&](const Piece& p) {
      if (p.span.far <= cut.near || p.span.near >= cut.far) {
        kept_.push_back(p);
        return;
      }
      any = true;
      const bool below = cut.near - p.span.near > thinnest_, above = p.span.far - cut.far > thinnest_;
      if (below) kept_.push_back({{p.span.near, cut.near}, p.normals, {p.origins.near, origins.far}});
      if (above) kept_.push_back({{cut.far, p.span.far}, p.normals, {origins.near, p.origins.far}});
      removed(below ? cut.near : p.span.near, above ? cut.far : p.span.far);
    });
    if (any)
      store(r, cut);
    else
      follow(r, cut);
    return any;
  }

  /// Calls visit(ray, s, origin, normal) for each end, at height s, whose normal is not stored yet. Both are
  /// references, valid until the next cut: after storing the normal, set the origin to kStored.
  template <class Visit>
  void each_unresolved(const Visit& visit) {
    const auto end = [&](int r, double s, double& origin, dexel::PackedNormal& n) {
      if (origin >= 0) visit(r, s, origin, n);
    };
    const auto span = [&](int r, const dexel::Span& s, Origins& origins, dexel::SpanNormals& n) {
      end(r, s.near, origins.near, n.near), end(r, s.far, origins.far, n.far);
    };
    for (int row = 0; planes_.first_origins && row < dexel::kTileSide; ++row)
      for (std::uint32_t left = pending_[row]; left; left &= left - 1) {
        const int r = row * dexel::kTileSide + std::countr_zero(left);
        if (first_.spans[r].near < first_.spans[r].far) span(r, first_.spans[r], first_.origins[r], first_.normals[r]);
        if (is(two_, r)) span(r, last_.spans[r], last_.origins[r], last_.normals[r]);
        if (!is(many_, r)) continue;
        const PiecePool::Place at = pool_.at(r);
        Piece* const pieces = pool_.pieces(at);
        for (std::uint32_t k = 0; k < at.count; ++k)
          if (Piece& p = pieces[k]; k - at.pair > 1) span(r, p.span, p.origins, p.normals);
      }
  }
  /// Packs the result, with a new revision, and continues from it. All normals must be stored.
  std::shared_ptr<const dexel::Tile> pack();

 private:
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  static constexpr int kRoom = dexel::kTileRays + base::kLanes;
  static constexpr std::uint32_t bit(int r) { return 1U << (r % dexel::kTileSide); }

  struct Plane {
    base::BlockVector<dexel::Span> spans;
    base::BlockVector<Origins> origins;             // empty if the grid stores no normals
    base::BlockVector<dexel::SpanNormals> normals;  // same
    void reserve(bool with_normals);
  };

  bool is(const std::uint32_t* mask, int r) const { return mask[r / dexel::kTileSide] & bit(r); }
  static Piece piece(const Plane& plane, int r, bool with_normals) {
    if (!with_normals) return {plane.spans[r], {}, {}};
    return {plane.spans[r], plane.normals[r], plane.origins[r]};
  }
  template <class Visit>
  void each(int r, const Visit& visit) const {
    if (!is(many_, r)) {
      if (first_.spans[r].near < first_.spans[r].far) visit(piece(first_, r, with_normals_));
      if (is(two_, r)) visit(piece(last_, r, with_normals_));
      return;
    }
    const PiecePool::Place at = pool_.at(r);
    const Piece* const pieces = pool_.pieces(at);
    for (std::uint32_t k = 0; k < at.count; ++k)
      if (k - at.pair > 1)  // unsigned: below the pair, too
        visit(pieces[k]);
      else
        visit(piece(k == at.pair ? first_ : last_, r, with_normals_));
  }

  void open_planes() {
    if (!planes_.first) unpack(*source_);
  }
  void unpack(const dexel::Tile& tile);
  void put(int r, const Piece* pieces, std::uint32_t n, std::uint32_t pair);
  void store(int r, const Interval& cut);
  void follow(int r, const Interval& cut);
  std::uint32_t pair_at(const Interval& cut) const;
  std::uint32_t count(int r) const;

  std::shared_ptr<const dexel::Tile> source_;
  bool with_normals_ = false, changed_ = false;
  double thinnest_ = 0;
  RayPlanes planes_{};  // null while the source is read in place
  std::uint32_t two_[dexel::kTileSide], many_[dexel::kTileSide];
  std::uint32_t pending_[dexel::kTileSide];  // rays with ends whose normals are not stored yet
  Plane first_, last_;
  base::BlockVector<dexel::Span> hull_;
  PiecePool pool_;  // of rays in many_
  base::BlockVector<Piece> kept_;
};

}  // namespace riffler::sweep
