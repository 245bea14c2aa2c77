#include "brush/rebuild.hpp"

#include <algorithm>
#include <cmath>

#include "dexel/joiner.hpp"

namespace riffler::brush {

namespace {

using dexel::Grid;
using dexel::PackedNormal;
using dexel::Span;
using dexel::SpanNormals;

/// An end that would move by less, in pitches, stays bit-identical.
constexpr double kStays = 1e-6;
/// Smallest displacement, in pitches, from which a crossing of the mesh without an end on the ray counts: nothing
/// appears where nothing moves.
constexpr double kAppears = 1e-3;
/// Largest distance along the normal, in pitches, between an end and the crossing of the mesh at the same wall.
constexpr double kSame = 0.75;

/// An end of material on a ray, in the volume's frame.
struct End {
  double w;
  PackedNormal normal;
  bool operator==(const End&) const = default;
};

constexpr int kNone = -1;

/// Rebuilds one ray after another; the vectors keep their memory.
class RayBuilder {
 public:
  RayBuilder(const Displacement& displacement, Axis axis, double pitch, const Interval& box)
      : displacement_(displacement), axis_(axis), pitch_(pitch), box_(box) {}

  double lost = 0;  // mm of the ray
  bool clipped = false;

  /// Returns whether the ray changes; its ends are then in `ends`. `place`: the ray's u, v and the frame's origin along
  /// it, in the crop's frame.
  bool build(std::span<const Span> ray, std::span<const SpanNormals> normals, std::span<const Crossing> before,
             std::span<const Crossing> after, const Vec3& place) {
    place_ = place;
    const Interval local = displacement_.reach().along(axis_, place.x, place.y);
    if (local.empty()) return false;
    chord_ = Interval{local.near + place.z, local.far + place.z}.cut(box_);
    if (chord_.empty()) return false;
    old_.clear();
    for (std::size_t k = 0; k < ray.size(); ++k)
      old_.push_back({ray[k].near, normals[k].near}), old_.push_back({ray[k].far, normals[k].far});
    match(before);
    place_new_ends(before, after);
    join(after.size());
    move_thin();
    return !(ends == old_);
  }

  std::vector<End> ends;

 private:
  struct NewEnd {
    End end;
    bool enters;
    bool operator<(const NewEnd& o) const { return end.w < o.end.w; }
  };

  bool enters(std::size_t old) const { return old % 2 == 0; }
  double normal_along(std::size_t old) const { return to_local(axis_, old_[old].normal.unpack()).z; }

  /// Finds, for each crossing before the displacement, the old end at the same wall.
  void match(std::span<const Crossing> before) {
    of_crossing_.assign(before.size(), kNone), shown_.assign(old_.size(), false);
    if (before.size() == old_.size()) {
      bool all = true;
      for (std::size_t k = 0; k < old_.size() && all; ++k) all = same(k, before[k]);
      if (all) {
        for (std::size_t k = 0; k < old_.size(); ++k) of_crossing_[k] = static_cast<int>(k), shown_[k] = true;
        return;
      }
    }
    for (std::size_t c = 0; c < before.size(); ++c) {
      double best = std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < old_.size(); ++k) {
        const double off = std::abs(old_[k].w - place_.z - before[c].w);
        if (!shown_[k] && off < best && same(k, before[c])) best = off, of_crossing_[c] = static_cast<int>(k);
      }
      if (of_crossing_[c] != kNone) shown_[static_cast<std::size_t>(of_crossing_[c])] = true;
    }
  }
  bool same(std::size_t old, const Crossing& c) const {
    if (enters(old) != c.enters) return false;
    const double off = std::abs(old_[old].w - place_.z - c.w);
    return off * std::min(std::abs(normal_along(old)), std::abs(c.normal.z)) <= 0.3 * pitch_ || off <= kSame * pitch_;
  }

  /// The crossing before the displacement where the surface at `c` came from, or kNone.
  int origin_of(const Crossing& c, std::span<const Crossing> before, double aside) const {
    const double from = c.w - c.way.z;
    double best = pitch_ * (0.25 + 2 * aside);
    int found = kNone;
    for (std::size_t k = 0; k < before.size(); ++k)
      if (before[k].enters == c.enters && std::abs(before[k].w - from) < best)
        best = std::abs(before[k].w - from), found = static_cast<int>(k);
    return found;
  }

  void place_new_ends(std::span<const Crossing> before, std::span<const Crossing> after) {
    new_.clear(), ghost_.clear();
    for (const Crossing& c : after) {
      const double aside = std::sqrt(c.way.x * c.way.x + c.way.y * c.way.y) / pitch_, share = 1 - aside;
      double w = c.w;
      Vec3 normal = c.normal;
      bool ghost = false;
      if (share > 0) {
        const int from = origin_of(c, before, aside);
        const int old = from == kNone ? kNone : of_crossing_[static_cast<std::size_t>(from)];
        if (old != kNone) {
          const End& end = old_[static_cast<std::size_t>(old)];
          if (displacement_.weight(place_of(end.w)) == 0) {
            new_.push_back({end, c.enters}), ghost_.push_back(false);
            continue;
          }
          const Crossing& was = before[static_cast<std::size_t>(from)];
          w += share * (end.w - place_.z - was.w);
          normal += share * (to_local(axis_, end.normal.unpack()) - was.normal);
        } else {
          ghost = from != kNone && glm::length(c.way) < kAppears * pitch_;
        }
      }
      new_.push_back({settled(w + place_.z, normal, c.enters), c.enters}), ghost_.push_back(ghost);
    }
  }
  Vec3 place_of(double w) const { return to_world(axis_, Vec3(place_.x, place_.y, w - place_.z)); }

  /// The end at w, or an old end of the same kind that is there already.
  End settled(double w, const Vec3& normal, bool enters_there) {
    for (std::size_t k = 0; k < old_.size(); ++k)
      if (enters(k) == enters_there && std::abs(old_[k].w - w) <= kStays * pitch_) return old_[k];
    if (w < box_.near - kStays * pitch_ || w > box_.far + kStays * pitch_) clipped = true;
    // Out of the material, even if the ray grazes the surface.
    const double out = enters_there ? -1 : 1;
    const Vec3 n(normal.x, normal.y, out * std::max(normal.z * out, 1e-4));
    return {w, PackedNormal::pack(to_world(axis_, glm::normalize(n)))};
  }

  /// The old ends outside the chord, and the new ones in it.
  void join(std::size_t count) {
    first_ = 0;
    while (first_ < old_.size() && old_[first_].w < chord_.near) ++first_;
    std::size_t last = first_;
    while (last < old_.size() && old_[last].w <= chord_.far) ++last;
    std::size_t n = 0;
    for (std::size_t k = 0; k < count; ++k) {
      if (k + 1 < count && ghost_[k] && ghost_[k + 1]) {
        ++k;
        continue;
      }
      NewEnd e = new_[k];
      if (e.end.w < chord_.near - 0.5 * pitch_ || e.end.w > chord_.far + 0.5 * pitch_) continue;
      if (e.end.w < chord_.near || e.end.w > chord_.far) {
        const bool kept = std::find(old_.begin(), old_.end(), e.end) != old_.end();
        if (kept) continue;
        e.end.w = std::clamp(e.end.w, chord_.near, chord_.far);
      }
      new_[n++] = e;
    }
    new_.resize(n);
    std::stable_sort(new_.begin(), new_.end());
    ends.assign(old_.begin(), old_.begin() + static_cast<std::ptrdiff_t>(first_));
    bool inside = first_ % 2 == 1;
    for (const NewEnd& e : new_)
      if (e.enters != inside) ends.push_back(e.end), inside = !inside;
    if (inside != (last % 2 == 1)) {
      if (ends.size() > first_)
        ends.pop_back();
      else
        ends.push_back({chord_.far, PackedNormal::pack(to_world(axis_, Vec3(0, 0, inside ? 1 : -1)))});
    }
    after_ = ends.size();
    ends.insert(ends.end(), old_.begin() + static_cast<std::ptrdiff_t>(last), old_.end());
  }

  /// Walls and gaps that the mesh does not show.
  void move_thin() {
    for (std::size_t k = 0; k + 1 < old_.size(); ++k) {
      if (shown_[k] || shown_[k + 1] || old_[k].w < chord_.near || old_[k + 1].w > chord_.far) continue;
      const bool wall = enters(k);
      double w[2];
      bool apart = false;
      for (std::size_t side = 0; side < 2; ++side) {
        const Vec3 normal = old_[k + side].normal.unpack();
        const Vec3 d = to_local(axis_, displacement_(place_of(old_[k + side].w), normal)), n = to_local(axis_, normal);
        apart = apart || d.x * d.x + d.y * d.y > pitch_ * pitch_;
        const double steep = std::copysign(std::max(std::abs(n.z), 0.2), n.z);
        w[side] = std::clamp(old_[k + side].w + glm::dot(d, n) / steep, chord_.near, chord_.far);
      }
      if (apart)
        lost += wall ? old_[k + 1].w - old_[k].w : 0;
      else if (w[0] < w[1])
        set(End{w[0], old_[k].normal}, End{w[1], old_[k + 1].normal}, wall);
      ++k;
    }
  }

  /// Makes [a, b] material or air.
  void set(const End& a, const End& b, bool material) {
    const auto at = [&](std::size_t k) { return ends.begin() + static_cast<std::ptrdiff_t>(k); };
    std::size_t lower = first_, upper;
    while (lower < after_ && ends[lower].w < a.w) ++lower;
    for (upper = lower; upper < after_ && ends[upper].w <= b.w;) ++upper;
    End put[2];
    int n = 0;
    if ((lower % 2 == 1) != material) put[n++] = a;
    if ((upper % 2 == 1) != material) put[n++] = b;
    after_ = after_ - (upper - lower) + static_cast<std::size_t>(n);
    ends.erase(at(lower), at(upper));
    ends.insert(at(lower), put, put + n);
  }

  const Displacement& displacement_;
  Axis axis_;
  double pitch_;
  Interval box_, chord_;
  Vec3 place_{0};
  std::vector<End> old_;
  std::vector<int> of_crossing_;
  std::vector<bool> shown_, ghost_;
  std::vector<NewEnd> new_;
  std::size_t first_ = 0, after_ = 0;  // ends in the chord: [first_, after_)
};

}  // namespace

Rebuild::Rebuild(const Grid& grid, const Crop& crop, const Patch& patch, const Displacement& displacement)
    : grid_(grid),
      own_(*crop.volume.grid(grid.axis())),
      displacement_(displacement),
      origin_(to_local(grid.axis(), crop.origin)),
      i0_(static_cast<int>(to_local(grid.axis(), Vec3(crop.first)).x)),
      j0_(static_cast<int>(to_local(grid.axis(), Vec3(crop.first)).y)),
      rays_(own_, patch) {}

std::vector<std::size_t> Rebuild::tiles() const {
  std::vector<std::size_t> out;
  for (int a = i0_ / dexel::kTileSide; a <= (i0_ + own_.nu() - 1) / dexel::kTileSide; ++a)
    for (int b = j0_ / dexel::kTileSide; b <= (j0_ + own_.nv() - 1) / dexel::kTileSide; ++b)
      out.push_back(grid_.tile_index(a, b));
  return out;
}

Rebuild::Result Rebuild::run(std::size_t tile) const {
  const std::shared_ptr<const dexel::Tile>& before = grid_.shared_tile(tile);
  const int u0 = static_cast<int>(tile) / grid_.tiles_v() * dexel::kTileSide;
  const int v0 = static_cast<int>(tile) % grid_.tiles_v() * dexel::kTileSide;
  const Axis axis = grid_.axis();
  RayBuilder ray(displacement_, axis, grid_.pitch(), {grid_.box().lower.z, grid_.box().upper.z});
  dexel::TileBuilder builder(true);
  Result out{before, 0, false, {}};
  for (int r = 0; r < dexel::kTileRays; ++r, builder.next_ray()) {
    const int i = u0 + r / dexel::kTileSide, j = v0 + r % dexel::kTileSide, a = i - i0_, b = j - j0_;
    const auto spans = before->ray(r);
    const auto normals = before->ray_normals(r);
    bool changes = false;
    if (a >= 0 && a < own_.nu() && b >= 0 && b < own_.nv() &&
        rays_.wanted[static_cast<std::size_t>(a) * static_cast<std::size_t>(own_.nv()) + static_cast<std::size_t>(b)]) {
      ++out.stats.rays_tested;
      ray.lost = 0;
      changes =
          ray.build(spans, normals, rays_.before.ray(a, b), rays_.after.ray(a, b), {own_.u(a), own_.v(b), origin_.z});
      out.lost += ray.lost * grid_.area(i, j);
    }
    if (changes) {
      ++out.stats.rays_changed;
      dexel::Joiner joiner(builder, dexel::kSliver * grid_.pitch());
      for (std::size_t k = 0; k + 1 < ray.ends.size(); k += 2)
        joiner.open(ray.ends[k].w, ray.ends[k].normal), joiner.close(ray.ends[k + 1].w, ray.ends[k + 1].normal);
      joiner.flush();
    } else {
      for (std::size_t k = 0; k < spans.size(); ++k) builder.add(spans[k], normals[k]);
    }
  }
  out.clipped = ray.clipped;
  if (out.stats.rays_changed > 0) out.tile = builder.finish();
  return out;
}

}  // namespace riffler::brush
