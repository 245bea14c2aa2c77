// A tile while it is being cut: its rays in a form that can shrink and split, written back as a new tile at the end.
#pragma once

#include <memory>
#include <vector>

#include "dexel/tile.hpp"

namespace riffler {

/// Reads the tile until the first cut, then works on a copy of its rays.
class TileCut {
 public:
  /// Spans left thinner than `thinnest` vanish.
  TileCut(const Tile& tile, bool with_normals, double thinnest)
      : tile_(tile), with_normals_(with_normals), thinnest_(thinnest) {}

  std::span<const Span> ray(int r) const {
    return changed_ ? std::span<const Span>(spans_.data() + begin_[r], count_[r]) : tile_.ray(r);
  }

  /// Takes [cut.near, cut.far] from ray r. `normals(near, far)` is asked for the normals of the two new ends only if
  /// there are any; `removed(near, far)` is told every piece of material taken. Returns whether anything was.
  template <class Normals, class Removed>
  bool subtract(int r, const Interval& cut, const Normals& normals, const Removed& removed) {
    bool any = false;
    for (const Span& s : ray(r)) any = any || (s.far > cut.near && s.near < cut.far);
    if (!any) return false;
    open();
    kept_.clear(), kept_normals_.clear();
    SpanNormals ends;
    bool have_ends = false;
    for (std::uint32_t k = begin_[r]; k < begin_[r] + count_[r]; ++k) {
      const Span s = spans_[k];
      const SpanNormals n = with_normals_ ? normals_[k] : SpanNormals{};
      if (s.far <= cut.near || s.near >= cut.far) {
        keep(s, n);
        continue;
      }
      const bool below = cut.near - s.near > thinnest_, above = s.far - cut.far > thinnest_;
      if (with_normals_ && (below || above) && !have_ends) normals(ends.near, ends.far), have_ends = true;
      if (below) keep({s.near, cut.near}, {n.near, ends.near});
      if (above) keep({cut.far, s.far}, {ends.far, n.far});
      removed(below ? cut.near : s.near, above ? cut.far : s.far);
    }
    store(r);
    return true;
  }

  bool changed() const { return changed_; }
  /// The result, packed, with a fresh revision.
  std::shared_ptr<Tile> finish() const;

 private:
  void open();
  void store(int r);
  void keep(const Span& s, const SpanNormals& n) {
    kept_.push_back(s);
    if (with_normals_) kept_normals_.push_back(n);
  }

  const Tile& tile_;
  bool with_normals_, changed_ = false;
  double thinnest_;
  std::vector<std::uint32_t> begin_, count_;
  std::vector<Span> spans_;  // rays that grew lie at the end; their old places are forgotten
  std::vector<SpanNormals> normals_;
  std::vector<Span> kept_;
  std::vector<SpanNormals> kept_normals_;
};

}  // namespace riffler
