// A square of 32 × 32 rays: the unit of sharing, copy on write, undo and re-meshing.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "riffler/base/block_pool.hpp"
#include "riffler/dexel/span.hpp"
#include "riffler/geom/interval.hpp"

namespace riffler::dexel {

inline constexpr int kTileSide = 32;
inline constexpr int kTileRays = kTileSide * kTileSide;

/// For each ray of a tile, the index of its first span, then the end of the last ray. In nearly all tiles every ray has
/// one span, or none has any; these two cases need no memory here. Immutable; copies share storage.
class RayOffsets {
 public:
  using Array = std::array<std::uint32_t, kTileRays + 1>;

  /// Offsets of a tile without spans.
  RayOffsets() : first_(none().data()) {}
  /// Offsets of any tile; shares storage for the two common cases.
  explicit RayOffsets(const Array& offsets);

  std::uint32_t operator[](int r) const { return first_[r]; }
  /// Whether every ray has exactly one span.
  bool one_each() const { return first_ == one().data(); }
  const std::uint32_t* data() const { return first_; }
  std::size_t size() const { return kTileRays + 1; }
  const std::uint32_t* begin() const { return first_; }
  const std::uint32_t* end() const { return first_ + size(); }
  /// Bytes of memory of its own.
  std::size_t nbytes() const { return own_ ? sizeof *own_ : 0; }
  bool operator==(const RayOffsets& o) const;

 private:
  static const Array& none();
  static const Array& one();
  std::shared_ptr<const Array> own_;  // null for none() and one()
  const std::uint32_t* first_;
};

/// The rays of one tile in compressed rows: ray r = a · 32 + b (a along u, b along v) owns the spans offset[r] to
/// offset[r + 1] − 1. A tile in a grid is immutable: volumes and snapshots share it, and a change replaces it. Rays of
/// a border tile that lie outside the grid are empty.
struct Tile {
  RayOffsets offset;
  base::BlockVector<Span> spans;
  base::BlockVector<SpanNormals> normals;  // as long as `spans`, or empty if the grid stores no normals
  Interval reach;                          // covers every span; after a cut it may be larger than necessary
  std::uint64_t revision = 0;              // changes with the content

  /// Spans, and normals at their ends, of ray r.
  std::span<const Span> ray(int r) const { return {spans.data() + offset[r], spans.data() + offset[r + 1]}; }
  std::span<const SpanNormals> ray_normals(int r) const {
    return normals.empty() ? std::span<const SpanNormals>{}
                           : std::span<const SpanNormals>{normals.data() + offset[r], normals.data() + offset[r + 1]};
  }
  /// Bytes in use.
  std::size_t nbytes() const;
};

/// Whether both tiles have the same spans and normals, regardless of the revision.
inline bool same_material(const Tile& a, const Tile& b) {
  return a.offset == b.offset && a.spans == b.spans && a.normals == b.normals;
}

/// A new revision number, greater than all earlier ones in this process.
std::uint64_t next_revision();

/// Builds a tile ray by ray, in the order r = 0 … 1023. Rays not written before `finish` are empty.
class TileBuilder {
 public:
  explicit TileBuilder(bool with_normals) : with_normals_(with_normals) { clear(); }

  /// Appends one span to the current ray. The caller keeps spans sorted and disjoint.
  void add(const Span& span, const SpanNormals& normals = {}) {
    tile_.spans.push_back(span);
    if (with_normals_) tile_.normals.push_back(normals);
    tile_.reach.include(span.near), tile_.reach.include(span.far);
  }
  /// Ends the current ray.
  void next_ray() { offset_[++rays_] = static_cast<std::uint32_t>(tile_.spans.size()); }
  /// Number of rays that have ended.
  int rays() const { return rays_; }
  /// Returns the tile, its storage trimmed, with a new revision. The builder is then empty.
  std::shared_ptr<Tile> finish();

 private:
  void clear();
  bool with_normals_;
  int rays_ = 0;
  RayOffsets::Array offset_{};
  Tile tile_;
};

}  // namespace riffler::dexel
