#include "mesh/decimate/flat_brick.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "mesh/adjacency.hpp"

namespace riffler::mesh {

namespace {

// Twice the area over the square of the longest edge: a vertex merges into the first neighbour with which all new
// triangles have kGood, otherwise into the best one if they have kFair or are no worse than those they replace.
constexpr double kGood = 0.25, kFair = 0.04;
/// Least height of a new triangle, in thicknesses of its flat, so that its normal leans by less than 8°.
constexpr double kHeights = 32;
/// Least cosine between the normals of a flat's plane and of its triangles.
constexpr double kLean = 0.95;
/// Largest number of triangles around a vertex that goes.
constexpr std::size_t kMostSpokes = 16;
constexpr int kMostRounds = 40;

/// Numbers a mesh's vertices in the order of their first use.
class Numbers {
 public:
  explicit Numbers(std::size_t most) : mask_(std::bit_ceil(2 * most + 2) - 1), key_(mask_ + 1, -1), value_(mask_ + 1) {}

  /// The number of `vertex`; `next` if it is new.
  int operator()(int vertex, int next) {
    std::size_t at = ((static_cast<std::uint64_t>(vertex) * 0x9E3779B97F4A7C15U) >> 24) & mask_;
    for (; key_[at] != vertex; at = (at + 1) & mask_)
      if (key_[at] < 0) {
        key_[at] = vertex;
        return value_[at] = next;
      }
    return value_[at];
  }

 private:
  std::size_t mask_;
  std::vector<int> key_, value_;
};

}  // namespace

FlatBrick::FlatBrick(const Vertices& points, const Triangles& all, std::span<const int> triangles,
                     std::span<const std::uint8_t> uses)
    : triangles_(triangles), start_(3 * triangles.size(), -1) {
  Numbers numbers(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Vec3i& corner = all[triangles[t]];
    if (repeats_a_vertex(corner)) continue;
    for (int k = 0; k < 3; ++k) {
      const int next = static_cast<int>(vertex_.size()), v = numbers(corner[k], next);
      if (v == next) vertex_.push_back(corner[k]), point_.push_back(points[corner[k]]);
      start_[3 * t + k] = v;
    }
  }
  join();
  find_whole(uses);
}

/// Joins two half-edges if they are the only ones of their edge and run in opposite directions.
void FlatBrick::join() {
  const int halves = static_cast<int>(start_.size());
  std::vector<int> begin(vertex_.size() + 1, 0), ends(start_.size()), half_of(start_.size());
  for (const int v : start_)
    if (v >= 0) ++begin[v];
  for (std::size_t v = 1; v < begin.size(); ++v) begin[v] += begin[v - 1];
  for (int half = halves - 1; half >= 0; --half) {
    if (start_[half] < 0) continue;
    const int at = --begin[start_[half]];
    ends[at] = start_[next_half(half)], half_of[at] = half;
  }
  /// The only half-edge from a to b; -1 for none or several.
  const auto only = [&](int a, int b) {
    int found = -1;
    for (int at = begin[a]; at < begin[a + 1]; ++at)
      if (ends[at] == b) {
        if (found >= 0) return -1;
        found = half_of[at];
      }
    return found;
  };
  twin_.assign(start_.size(), -1);
  for (int half = 0; half < halves; ++half)
    if (start_[half] >= 0 && twin_[half] < 0) {
      const int a = start_[half], b = start_[next_half(half)];
      if (a > b) continue;
      if (const int twin = only(b, a); twin >= 0 && only(a, b) == half) twin_[half] = twin, twin_[twin] = half;
    }
}

void FlatBrick::find_whole(std::span<const std::uint8_t> uses) {
  std::vector<int> here(vertex_.size(), 0);
  out_.assign(vertex_.size(), -1);
  for (std::size_t half = 0; half < start_.size(); ++half)
    if (const int v = start_[half]; v >= 0) ++here[v], out_[v] = static_cast<int>(half);
  whole_.assign(vertex_.size(), 0);
  for (std::size_t v = 0; v < vertex_.size(); ++v) {
    if (here[v] != uses[vertex_[v]] || here[v] == 255) continue;
    int half = out_[v], count = 0;
    do {
      half = twin_[previous_half(half)], ++count;
    } while (half >= 0 && half != out_[v]);
    whole_[v] = half >= 0 && count == here[v];
  }
}

std::array<Vec3, 3> FlatBrick::corners(int t) const {
  return {point_[start_[3 * t]], point_[start_[3 * t + 1]], point_[start_[3 * t + 2]]};
}

std::size_t FlatBrick::run(double slack) {
  find_flats(slack);
  find_inner();
  touched_.assign(vertex_.size(), -1), mark_.assign(vertex_.size(), -1);
  std::vector<int> open;
  for (int v = 0; v < static_cast<int>(vertex_.size()); ++v)
    if (flat_at_[v] >= 0) open.push_back(v);
  // Vertices that go in the same round are not neighbours, which keeps triangles well shaped. A vertex stays open as
  // long as a round changes something around it.
  std::size_t lost = 0;
  std::vector<int> later;
  for (round_ = 0; round_ < kMostRounds && !open.empty(); ++round_) {
    const std::size_t before = lost;
    later.clear();
    for (const int v : open) {
      if (touched_[v] != round_ && remove(v))
        lost += 2;
      else
        later.push_back(v);
    }
    open.swap(later);
    if (lost - before < open.size() / 64 + 1) break;
  }
  return lost;
}

/// Divides the triangles into flats, from the first one that is in none. A flat that a small triangle's plane has let
/// grow far enough gets the plane that fits all of it, which reaches farther.
void FlatBrick::find_flats(double slack) {
  const int triangles = static_cast<int>(triangles_.size());
  flat_of_.assign(triangles_.size(), -1), seen_.assign(triangles_.size(), -1);
  for (int seed = 0; seed < triangles; ++seed) {
    if (gone(seed) || flat_of_[seed] >= 0) continue;
    const std::array<Vec3, 3> p = corners(seed);
    const Vec3 cross = glm::cross(p[1] - p[0], p[2] - p[0]);
    const double length = glm::length(cross);
    if (!(length > 0)) continue;
    Plane plane{cross / length, p[0]};
    grow(seed, plane, slack);
    for (int turn = 0; turn < 4 && grown_.size() > 3 && thickness_ > 0.1 * slack; ++turn) {
      const std::vector<int> before = grown_;
      const double thickness = thickness_;
      const Plane better = fitted();
      if (grow(seed, better, slack) && grown_.size() > before.size()) {
        plane = better;
        continue;
      }
      grown_ = before, thickness_ = thickness;
      break;
    }
    const Vec3 size = glm::abs(plane.normal);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const int x = (axis + 1) % 3, y = (axis + 2) % 3;
    const bool up = plane.normal[axis] > 0;
    for (const int t : grown_) flat_of_[t] = static_cast<int>(flats_.size());
    flats_.push_back({up ? x : y, up ? y : x, thickness_});
  }
}

/// Fills `grown_` from `seed`. Returns false if the seed itself does not fit.
bool FlatBrick::grow(int seed, const Plane& plane, double slack) {
  ++stamp_;
  grown_.clear(), thickness_ = 0;
  const Vec3 size = glm::abs(plane.normal);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const auto take = [&](int t) {
    seen_[t] = stamp_;
    const std::array<Vec3, 3> p = corners(t);
    double thickness = thickness_;
    for (const Vec3& q : p) thickness = std::max(thickness, std::abs(glm::dot(plane.normal, q - plane.point)));
    if (!(thickness <= slack)) return false;
    const Vec3 cross = glm::cross(p[1] - p[0], p[2] - p[0]);
    const double lean = glm::dot(cross, plane.normal);
    if (!(lean > 0 && lean * lean >= kLean * kLean * glm::dot(cross, cross) && cross[axis] * plane.normal[axis] > 0))
      return false;
    thickness_ = thickness;
    grown_.push_back(t);
    return true;
  };
  if (!take(seed)) return false;
  for (std::size_t next = 0; next < grown_.size(); ++next)
    for (int half = 3 * grown_[next], k = 0; k < 3; ++k)
      if (const int twin = twin_[half + k]; twin >= 0)
        if (const int t = triangle_of(twin); seen_[t] != stamp_ && flat_of_[t] < 0) take(t);
  return true;
}

/// The plane through the centre of `grown_` across the sum of its triangles' areas.
FlatBrick::Plane FlatBrick::fitted() const {
  Vec3 normal(0), centre(0);
  for (const int t : grown_) {
    const std::array<Vec3, 3> p = corners(t);
    normal += glm::cross(p[1] - p[0], p[2] - p[0]), centre += p[0] + p[1] + p[2];
  }
  return {glm::normalize(normal), centre / (3.0 * static_cast<double>(grown_.size()))};
}

/// Finds the vertices inside a flat.
void FlatBrick::find_inner() {
  constexpr int kNone = -2;
  flat_at_.assign(vertex_.size(), kNone);
  for (std::size_t half = 0; half < start_.size(); ++half) {
    if (start_[half] < 0) continue;
    int& at = flat_at_[start_[half]];
    const int flat = flat_of_[half / 3];
    at = at == kNone || at == flat ? flat : -1;
  }
  for (std::size_t v = 0; v < vertex_.size(); ++v)
    if (!whole_[v]) flat_at_[v] = -1;
}

bool FlatBrick::remove(int v) {
  if (!gather(v)) return false;
  std::size_t best = ring_.size();
  double best_worth = 0;
  for (std::size_t target = 0; target < ring_.size(); ++target) {
    const double worth = worst_if_to(target);
    if (worth > best_worth) best = target, best_worth = worth;
    if (best_worth >= kGood) break;
  }
  if (best == ring_.size() || !(best_worth >= std::min(kFair, worst_now_)) || !keeps_edges_single(best)) return false;
  moved_ = std::max(moved_, flat_.thickness);
  merge(best);
  return true;
}

/// Collects the fan of v. Returns false if it is too large, or winds around v more than once.
bool FlatBrick::gather(int v) {
  spoke_.clear(), ring_.clear();
  for (int half = out_[v]; spoke_.empty() || half != out_[v]; half = twin_[previous_half(half)]) {
    if (spoke_.size() == kMostSpokes) return false;
    spoke_.push_back(half), ring_.push_back(start_[next_half(half)]);
  }
  flat_ = flats_[flat_at_[v]];
  const Vec3& p = point_[v];
  int turns = 0;
  worst_now_ = 1;
  for (std::size_t i = 0; i < ring_.size(); ++i) {
    const Vec3 a = point_[ring_[i]] - p, b = point_[ring_[i + 1 < ring_.size() ? i + 1 : 0]] - p, c = b - a;
    turns += a[flat_.y] <= 0 && b[flat_.y] > 0 ? 1 : 0;
    const double area = a[flat_.x] * b[flat_.y] - a[flat_.y] * b[flat_.x];
    worst_now_ = std::min(worst_now_, area / std::max({glm::dot(a, a), glm::dot(b, b), glm::dot(c, c)}));
  }
  return turns == 1;
}

/// Twice the projected area over the square of the longest edge, of the worst triangle if v merges into that vertex of
/// the ring; 0 if one would turn over or lean.
double FlatBrick::worst_if_to(std::size_t target) const {
  const Vec3& p = point_[ring_[target]];
  double worst = 1;
  for (std::size_t k = 1; k + 1 < ring_.size(); ++k) {
    const auto at = [&](std::size_t i) { return point_[ring_[i < ring_.size() ? i : i - ring_.size()]] - p; };
    const Vec3 a = at(target + k), b = at(target + k + 1), c = b - a;
    const double area = a[flat_.x] * b[flat_.y] - a[flat_.y] * b[flat_.x];
    const double square = std::max({glm::dot(a, a), glm::dot(b, b), glm::dot(c, c)});
    if (!(area > 0) || !(area * area > kHeights * kHeights * flat_.thickness * flat_.thickness * square)) return 0;
    worst = std::min(worst, area / square);
  }
  return worst;
}

/// Whether none of the new edges, from the target across the fan, exists already; with three neighbours, whether the
/// new triangle does not.
bool FlatBrick::keeps_edges_single(std::size_t target) {
  const std::size_t n = ring_.size();
  if (n <= 3) {
    const int one = twin_[next_half(spoke_[0])], other = twin_[next_half(spoke_[1])];
    return n == 3 && (one < 0 || other < 0 || triangle_of(one) != triangle_of(other));
  }
  const int to = ring_[target];
  ++stamp_;
  for (std::size_t k = 2; k + 1 < n; ++k) {
    const int other = ring_[(target + k) % n];
    mark_[other] = stamp_;
    if (!whole_[to] && (!whole_[other] || has_neighbour(other, to))) return false;
  }
  if (!whole_[to]) return true;
  int half = out_[to];
  do {
    if (mark_[start_[next_half(half)]] == stamp_) return false;
    half = twin_[previous_half(half)];
  } while (half != out_[to]);
  return true;
}

bool FlatBrick::has_neighbour(int v, int other) const {
  int half = out_[v];
  do {
    if (start_[next_half(half)] == other) return true;
    half = twin_[previous_half(half)];
  } while (half != out_[v]);
  return false;
}

/// Two triangles vanish; the edges that they leave are joined across them.
void FlatBrick::merge(std::size_t target) {
  const std::size_t n = ring_.size();
  const int to = ring_[target], after = ring_[(target + 1) % n], before = ring_[(target + n - 1) % n];
  const int first = spoke_[target], last = spoke_[(target + n - 1) % n];  // half-edges from v to `to`, to `before`
  for (const int half : spoke_) start_[half] = to;
  const auto close = [&](int kept, int beyond) {
    twin_[kept] = beyond;
    if (beyond >= 0) twin_[beyond] = kept;
  };
  // Left triangle (v, to, after): the edge v–after becomes the edge to–after. Right one (v, before, to) likewise.
  const int left = twin_[previous_half(first)], right = twin_[last];
  const int beyond_left = twin_[next_half(first)], beyond_right = twin_[next_half(last)];
  close(left, beyond_left), close(right, beyond_right);
  for (const int spoke : {first, last})
    for (int k = 0; k < 3; ++k) start_[3 * triangle_of(spoke) + k] = -1;
  out_[to] = left, out_[after] = next_half(left), out_[before] = right;
  for (const int v : ring_) touched_[v] = round_;
}

void FlatBrick::store(Triangles& all) const {
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    Vec3i& corner = all[triangles_[t]];
    if (repeats_a_vertex(corner)) continue;
    if (gone(static_cast<int>(t)))
      corner = Vec3i(-1);
    else
      for (int k = 0; k < 3; ++k) corner[k] = vertex_[start_[3 * t + k]];
  }
}

double FlatBrick::moved() const {
  return 2 * std::sqrt(3.0) * moved_;
}

}  // namespace riffler::mesh
