// A tile while it is being cut: read where it lies, copied when something of it goes, packed again at the end.
#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "riffler/dexel/tile.hpp"
#include "sweep/ray_window.hpp"

namespace riffler::sweep {

/// What a TileCut writes in while it lives; a thread has one, so that no cut asks for memory that another had.
struct TileScratch {
  base::BlockVector<std::uint32_t> begin, count, room;  // of rays with several spans, in the pool
  base::BlockVector<dexel::Span> pool;                  // rays that grew lie at the end; their old places are forgotten
  base::BlockVector<dexel::SpanNormals> pool_normals;
  base::BlockVector<dexel::Span> kept;
  base::BlockVector<dexel::SpanNormals> kept_normals;
};

/// Every ray has one place: its only span (nearly all rays), or the hull of several, which live in a pool. An empty ray
/// has near > far there, so that no cut touches it. A tile whose rays have one span each is read where it lies, until
/// something of it is cut: most tiles that a tool passes lose nothing.
class TileCut {
 public:
  /// Spans left thinner than `thinnest` vanish. `tile` must outlive this. A thread has one of these at a time.
  TileCut(const dexel::Tile& tile, bool with_normals, double thinnest);

  const dexel::Span* rays() const { return rays_; }
  const std::uint32_t* many() const { return many_; }
  /// The places for writing spans that stay single; `emptied` says that some have become empty.
  dexel::Span* open();
  void emptied() { packed_ = false; }

  /// Takes [cut.near, cut.far] from ray r. `normal_at(s)` is asked for the normal of a new end at s, if normals are
  /// wanted; `removed(near, far)` is told every piece of material taken.
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

  /// The result, packed, with a fresh revision; null if nothing was cut.
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
  bool packed_;  // every ray holds one span, as tiles have them
  double thinnest_;
  const dexel::Span* rays_;
  const dexel::SpanNormals* normals_;   // of the places
  std::shared_ptr<dexel::Tile> fresh_;  // once it is opened, holds the places
  std::uint32_t many_[dexel::kTileSide];
  TileScratch& scratch_;
};

}  // namespace riffler::sweep
