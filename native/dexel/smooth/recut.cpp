#include "dexel/smooth/recut.hpp"

#include "dexel/joiner.hpp"
#include "geom/hypot.hpp"

namespace riffler::dexel {

namespace {

/// Spacing of the field samples on a ray, in pitches. A new feature thinner than this is not found.
constexpr double kSampleStep = 0.5;
/// The field approximates the distance from the surface, so steps of this fraction of its value do not cross the
/// surface.
constexpr double kTrust = 0.7;
/// Accuracy of ends, in pitches.
constexpr double kEndTolerance = 1e-6;
/// An end that would move by less stays bit-identical, pitches.
constexpr double kStays = 1e-6;

}  // namespace

Recutter::Recutter(const Grid& grid, MovedField& field) : grid_(grid), field_(field), pitch_(grid.pitch()) {}

std::shared_ptr<const Tile> Recutter::run(std::size_t tile, const Vec3& centre, double radius, Stats& stats) {
  const std::shared_ptr<const Tile>& before = grid_.shared_tile(tile);
  const Vec3 c = to_local(grid_.axis(), centre);
  const int i0 = static_cast<int>(tile) / grid_.tiles_v() * kTileSide;
  const int j0 = static_cast<int>(tile) % grid_.tiles_v() * kTileSide;
  TileBuilder builder(true);
  std::uint64_t changed = 0;
  values_ = 0;
  for (int r = 0; r < kTileRays; ++r, builder.next_ray()) {
    const int i = i0 + r / kTileSide, j = j0 + r % kTileSide;
    const std::span<const Span> ray = before->ray(r);
    const std::span<const SpanNormals> normals = before->ray_normals(r);
    bool anew = false;
    if (i < grid_.nu() && j < grid_.nv() && geom::hypot(grid_.u(i) - c.x, grid_.v(j) - c.y) <= radius) {
      const std::span<const Interval> changes = field_.look_along(grid_.u(i), grid_.v(j));
      if (!changes.empty()) ++stats.rays_tested, anew = recut(ray, normals, changes);
    }
    if (anew) {
      ++changed;
      Joiner joiner(builder, kSliver * pitch_);
      for (std::size_t k = 0; k < ends_.size(); k += 2)
        joiner.open(ends_[k].w, ends_[k].normal), joiner.close(ends_[k + 1].w, ends_[k + 1].normal);
      joiner.flush();
    } else {
      for (std::size_t k = 0; k < ray.size(); ++k) builder.add(ray[k], normals[k]);
    }
  }
  stats.rays_changed += changed, stats.hits += values_;
  return changed > 0 ? builder.finish() : before;
}

/// Computes `ends_` of a ray. Returns false if they are unchanged.
bool Recutter::recut(std::span<const Span> ray, std::span<const SpanNormals> normals,
                     std::span<const Interval> changes) {
  old_.clear(), ends_.clear();
  for (std::size_t k = 0; k < ray.size(); ++k)
    old_.push_back({ray[k].near, normals[k].near}), old_.push_back({ray[k].far, normals[k].far});
  std::size_t next = 0;  // index of the next old end
  for (const Interval& c : changes) {
    const Interval change = c.cut({grid_.box().lower.z, grid_.box().upper.z});
    if (!(change.near < change.far)) continue;
    for (; next < old_.size() && old_[next].w < change.near; ++next) ends_.push_back(old_[next]);
    std::size_t last = next;
    while (last < old_.size() && old_[last].w <= change.far) ++last;
    follow(change, next, last);
    next = last;
  }
  ends_.insert(ends_.end(), old_.begin() + static_cast<std::ptrdiff_t>(next), old_.end());
  return ends_ != old_;
}

/// Finds the ends within `change`, which contains old_[first] to old_[last − 1]. The rest of the ray is unchanged.
void Recutter::follow(const Interval& change, std::size_t first, std::size_t last) {
  place_stops(change, first, last);
  const auto inside = [](double value) { return value < 0; };
  Sample before{change.near, value(change.near)};
  if (inside(before.value) != (first % 2 == 1)) push(before.w, {0, 0, inside(before.value) ? -1 : 1});
  for (const double stop : stops_)
    while (before.w < stop) {
      const double step = std::max(kSampleStep * pitch_, kTrust * std::abs(before.value));
      const double w = before.w + step < stop ? before.w + step : stop;
      const Sample next{w, value(w)};
      if (inside(before.value) != inside(next.value)) cross(before, next);
      before = next;
    }
  if (inside(before.value) != (last % 2 == 1)) push(before.w, {0, 0, inside(before.value) ? 1 : -1});
}

/// Places that no step may skip: the old ends and the midpoints between them, so that thin old features are not missed.
void Recutter::place_stops(const Interval& change, std::size_t first, std::size_t last) {
  stops_.clear();
  for (std::size_t k = first; k < last; ++k) {
    stops_.push_back(old_[k].w);
    if (k + 1 < last) stops_.push_back(0.5 * (old_[k].w + old_[k + 1].w));
  }
  stops_.push_back(change.far);
}

double Recutter::value(double w) {
  ++values_;
  const auto after = std::partition_point(old_.begin(), old_.end(), [w](const End& e) { return e.w < w; });
  const FieldValue v = field_(w, (after - old_.begin()) % 2 == 1);
  normal_ = v.normal;
  return v.value;
}

/// Adds an end where the field is 0 between a and b, whose signs differ: the Illinois method (Dowell, Jarratt, "A
/// modified regula falsi method", 1971), with a bisection every fourth step, because it is slow where the field jumps.
void Recutter::cross(Sample a, Sample b) {
  const bool opens = b.value < 0;
  double w = b.w;
  int kept = 0;  // end of the bracket that the last step kept: 1 a, 2 b
  for (int step = 1; step <= 80 && b.w - a.w > kEndTolerance * pitch_; ++step) {
    const bool halves = step % 4 == 0;
    const double next = halves ? 0.5 * (a.w + b.w) : a.w + (b.w - a.w) * (a.value / (a.value - b.value));
    const bool settled = !halves && std::abs(next - w) < kEndTolerance * pitch_;
    w = next;
    if (settled) break;
    const double f = value(w);
    if (f == 0) break;
    const bool above = (f < 0) == opens;  // the end lies before w
    if (above) {
      if (kept == 1) a.value *= 0.5;
      b = {w, f}, kept = 1;
    } else {
      if (kept == 2) b.value *= 0.5;
      a = {w, f}, kept = 2;
    }
  }
  push(w, normal_);
}

void Recutter::push(double w, const Vec3& normal) {
  const bool opens = ends_.size() % 2 == 0;
  // Keep the old end of the same kind if it moves too little.
  const auto near =
      std::partition_point(old_.begin(), old_.end(), [&](const End& e) { return e.w < w - kStays * pitch_; });
  for (auto e = near; e != old_.end() && e->w <= w + kStays * pitch_; ++e)
    if (((e - old_.begin()) % 2 == 0) == opens && (ends_.empty() || ends_.back().w < e->w)) {
      ends_.push_back(*e);
      return;
    }
  // Points out of the material, even if the ray grazes the surface and the mean normal leans to the other side.
  const double out = opens ? -1 : 1;
  const Vec3 n = glm::normalize(Vec3(normal.x, normal.y, out * std::max(normal.z * out, 1e-4)));
  if (!ends_.empty()) w = std::max(w, ends_.back().w);
  ends_.push_back({w, PackedNormal::pack(to_world(grid_.axis(), n))});
}

}  // namespace riffler::dexel
