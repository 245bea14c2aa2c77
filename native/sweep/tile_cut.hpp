// A tile while it is being cut: its rays as planes of ends that can be cut many at a time, packed again at the end.
#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "dexel/tile.hpp"
#include "sweep/ray_window.hpp"

namespace riffler {

/// Rays with one span (nearly all) live in two planes, those with several in a pool. An empty ray has near > far, so
/// that no cut touches it.
class TileCut {
 public:
  /// Spans left thinner than `thinnest` vanish.
  TileCut(const Tile& tile, bool with_normals, double thinnest);

  /// Ends of a ray's only span, or of the hull of its spans; padded by kLanes. Whoever writes them calls `touch`.
  double* near() { return near_; }
  double* far() { return far_; }
  const std::uint32_t* many() const { return many_; }
  void touch() { changed_ = true; }

  /// Takes [cut.near, cut.far] from ray r. `normals(near, far)` is asked for the normals of the two new ends only if
  /// there are any; `removed(near, far)` is told every piece of material taken.
  template <class Normals, class Removed>
  void subtract(int r, const Interval& cut, const Normals& normals, const Removed& removed) {
    kept_.clear(), kept_normals_.clear();
    SpanNormals ends;
    bool have_ends = false, any = false;
    const std::uint32_t n = count(r);
    for (std::uint32_t k = 0; k < n; ++k) {
      const Span s = span(r, k);
      const SpanNormals old = with_normals_ ? normal(r, k) : SpanNormals{};
      if (s.far <= cut.near || s.near >= cut.far) {
        keep(s, old);
        continue;
      }
      any = true;
      const bool below = cut.near - s.near > thinnest_, above = s.far - cut.far > thinnest_;
      if (with_normals_ && (below || above) && !have_ends) normals(ends.near, ends.far), have_ends = true;
      if (below) keep({s.near, cut.near}, {old.near, ends.near});
      if (above) keep({cut.far, s.far}, {ends.far, old.far});
      removed(below ? cut.near : s.near, above ? cut.far : s.far);
    }
    if (any) store(r);
  }

  bool changed() const { return changed_; }
  /// The result, packed, with a fresh revision.
  std::shared_ptr<Tile> finish() const;

 private:
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  bool is_many(int r) const { return many_[r / kTileSide] >> (r % kTileSide) & 1U; }
  std::uint32_t count(int r) const { return is_many(r) ? count_[r] : (near_[r] < far_[r] ? 1U : 0U); }
  Span span(int r, std::uint32_t k) const { return is_many(r) ? pool_[begin_[r] + k] : Span{near_[r], far_[r]}; }
  const SpanNormals& normal(int r, std::uint32_t k) const {
    return is_many(r) ? pool_normals_[begin_[r] + k] : normals_[r];
  }
  void keep(const Span& s, const SpanNormals& n) {
    kept_.push_back(s);
    if (with_normals_) kept_normals_.push_back(n);
  }
  void put(int r, const Span* spans, const SpanNormals* normals, std::uint32_t n);
  void store(int r);
  void pack_single(Tile& tile) const;
  void pack_all(Tile& tile) const;

  bool with_normals_, changed_ = false;
  double thinnest_;
  alignas(64) double near_[kTileRays + kLanes], far_[kTileRays + kLanes];
  std::uint32_t many_[kTileSide];
  std::vector<SpanNormals> normals_;          // of the planes
  std::vector<std::uint32_t> begin_, count_;  // of rays with several spans, in the pool
  std::vector<Span> pool_;                    // rays that grew lie at the end; their old places are forgotten
  std::vector<SpanNormals> pool_normals_;
  std::vector<Span> kept_;
  std::vector<SpanNormals> kept_normals_;
};

}  // namespace riffler
