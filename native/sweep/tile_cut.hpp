// A tile during a cut: read in place, copied when the first material goes, packed again at the end.
#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "riffler/dexel/tile.hpp"
#include "sweep/ray_window.hpp"

namespace riffler::sweep {

/// Scratch memory of a TileCut. A thread has one, so cuts do not allocate again and again.
struct TileScratch {
  base::BlockVector<std::uint32_t> begin, count, room;  // for rays with several spans, in the pool
  base::BlockVector<dexel::Span> pool;                  // rays that grew are at the end; their old places stay unused
  base::BlockVector<dexel::SpanNormals> pool_normals;
  base::BlockVector<dexel::Span> kept;
  base::BlockVector<dexel::SpanNormals> kept_normals;
};

/// Every ray has one place: its only span (nearly all rays), or the hull of several spans, which are in a pool. The
/// place of an empty ray has near > far, so no cut touches it. A tile with one span in each ray is read in place until
/// something of it is cut: a tool passes over most tiles without removing anything.
class TileCut {
 public:
  /// Remaining spans thinner than `thinnest` (mm) vanish. `tile` must outlive the object. One per thread at a time.
  TileCut(const dexel::Tile& tile, bool with_normals, double thinnest);

  const dexel::Span* rays() const { return rays_; }
  const std::uint32_t* many() const { return many_; }
  /// The places, for writing spans that stay single. Call `emptied` if some have become empty.
  dexel::Span* open();
  void emptied() { packed_ = false; }

  /// Removes [cut.near, cut.far] from ray r. `normal_at(s)` returns the normal of a new end at s, if normals are
  /// stored; `removed(near, far)` is called for every piece of material removed.
  template <class Normal, class Removed>
  void subtract(int r, const Interval& cut, const Normal& normal_at, const Removed& removed) {
    scratch_.kept.clear(), scratch_.kept_normals.clear();
    const auto end = [&](double s) { return with_normals_ ? normal_at(s) : dexel::PackedNormal{}; };
    bool any = false;
    const std::uint32_t n = count(r);
    for (std::uint32_t k = 0; k < n; ++k) {
      const dexel::Span s = span(r, k);
      const dexel::SpanNormals old = with_normals_ ? normal(r, k) : dexel::SpanNormals{};
      if (s.far <= cut.near || s.near >= cut.far) {
        keep(s, old);
        continue;
      }
      any = true;
      const bool below = cut.near - s.near > thinnest_, above = s.far - cut.far > thinnest_;
      if (below) keep({s.near, cut.near}, {old.near, end(cut.near)});
      if (above) keep({cut.far, s.far}, {end(cut.far), old.far});
      removed(below ? cut.near : s.near, above ? cut.far : s.far);
    }
    if (any) store(r);
  }

  /// The packed result, with a new revision; null if nothing was cut.
  std::shared_ptr<dexel::Tile> finish();

 private:
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  bool is_many(int r) const { return many_[r / dexel::kTileSide] >> (r % dexel::kTileSide) & 1U; }
  std::uint32_t count(int r) const { return is_many(r) ? scratch_.count[r] : (rays_[r].near < rays_[r].far ? 1U : 0U); }
  const dexel::Span& span(int r, std::uint32_t k) const {
    return is_many(r) ? scratch_.pool[scratch_.begin[r] + k] : rays_[r];
  }
  const dexel::SpanNormals& normal(int r, std::uint32_t k) const {
    return is_many(r) ? scratch_.pool_normals[scratch_.begin[r] + k] : normals_[r];
  }
  void keep(const dexel::Span& s, const dexel::SpanNormals& n) {
    scratch_.kept.push_back(s);
    if (with_normals_) scratch_.kept_normals.push_back(n);
  }
  void put(int r, const dexel::Span* spans, const dexel::SpanNormals* normals, std::uint32_t n);
  void unpack();
  void store(int r);
  void pack_single(dexel::Tile& tile) const;
  void pack_all(dexel::Tile& tile) const;

  const dexel::Tile& tile_;
  bool with_normals_, changed_ = false;
  bool packed_;  // every ray holds one span, stored as in a tile
  double thinnest_;
  const dexel::Span* rays_;
  const dexel::SpanNormals* normals_;   // at the places
  std::shared_ptr<dexel::Tile> fresh_;  // after `open`, holds the places
  std::uint32_t many_[dexel::kTileSide];
  TileScratch& scratch_;
};

}  // namespace riffler::sweep
