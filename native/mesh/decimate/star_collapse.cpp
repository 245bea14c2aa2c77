#include "mesh/decimate/star_collapse.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace riffler::mesh {

namespace {

constexpr double kTouching = -0.98;  // cosine of two triangles that all but lie on each other
constexpr double kNear = 1e-4;       // weight of a target's distance compared with its height
constexpr int kTargets = 3;          // looked at for each vertex, of the least guesses
constexpr int kLevels = 8;           // of the error, from the cheapest merges to the dearest
constexpr int kQuickLevels = 2;
constexpr double kFlat = 1.0 / 4096;  // error that needs no closer look, over the tolerance

double squared(const Vec3& a) {
  return glm::dot(a, a);
}

double turn(const Vec3& a, const Vec3& b) {
  return a.x * b.y - a.y * b.x;
}

}  // namespace

float StarCollapser::rounded_up(double x) {
  const auto f = static_cast<float>(x);
  return static_cast<double>(f) >= x ? f : std::nextafter(f, std::numeric_limits<float>::infinity());
}

std::int32_t StarCollapser::seen(std::int32_t v) {
  const std::int32_t s = slot(v);
  if (s != kUnseen) return s;
  stars_.push_back({v, 0, false, false, true, 0, 0, Vec3(0)});
  around_.resize(around_.size() + kMostFaces);
  return slot_[static_cast<std::size_t>(v - first_)] = static_cast<std::int32_t>(stars_.size() - 1);
}

void StarCollapser::add(std::uint32_t triangle) {
  const Vec3i& v = mesh_.triangles[triangle];
  const std::int32_t slots[3] = {seen(v.x), seen(v.y), seen(v.z)};
  if (slots[0] < 0 && slots[1] < 0 && slots[2] < 0) return;
  const auto face = static_cast<std::int32_t>(faces_.size());
  const Vec3 &a = mesh_.vertices[v.x], &b = mesh_.vertices[v.y], &c = mesh_.vertices[v.z];
  faces_.push_back({v, triangle, glm::normalize(glm::cross(b - a, c - a)), mesh_.errors[triangle], 0});
  for (const std::int32_t s : slots) {
    if (s < 0) continue;
    Star& star = stars_[s];
    if (star.count == 0) star.facing = faces_.back().normal;
    see_normal(s, faces_.back().normal);
    if (star.count == kMostFaces)
      star.locked = true;
    else
      around(s)[star.count++] = face;
  }
}

void StarCollapser::run() {
  if (wide_ && effort_ == Effort::Full) {
    block_.clear();
    for (std::size_t k = 0; k < stars_.size(); ++k)
      if (!stars_[k].locked) block_.push_back(static_cast<std::int32_t>(k));
    flatten(block_.data(), block_.data() + block_.size());
  }
  // Cheap merges first.
  spread();
  const int levels = effort_ == Effort::Full ? kLevels : kQuickLevels;
  for (int level = 1; level <= levels; ++level) sweep(most_error_ * level / levels, wide_ ? 24 : kMostFaces);
  for (const Face& face : faces_) {
    mesh_.triangles[face.triangle] = face.v;
    mesh_.errors[face.triangle] = face.error;
  }
}

/// Lists the stars so that vertices next to each other are far apart in the list.
void StarCollapser::spread() {
  order_.clear();
  const std::size_t n = stars_.size();
  std::size_t stride = n * 5 / 8 | 1;
  while (n > 0 && std::gcd(stride, n) != 1) stride += 2;
  for (std::size_t k = 0, at = 0; k < n; ++k) {
    if (stars_[at].count > 0 && !stars_[at].locked) order_.push_back(static_cast<std::int32_t>(at));
    at += stride;
    if (at >= n) at %= n;
  }
}

/// Merges until nothing can be merged within `limit`.
void StarCollapser::sweep(double limit, int most_faces) {
  queue_.clear();
  std::erase_if(order_, [&](std::int32_t s) { return stars_[s].count == 0; });
  for (const std::int32_t s : order_) {
    Star& star = stars_[s];
    star.queued = star.needs <= limit;
    if (star.queued) queue_.push_back(s);
  }
  for (std::size_t k = 0; k < queue_.size(); ++k) {
    stars_[queue_[k]].queued = false;
    merge(queue_[k], limit, most_faces);
  }
}

/// Reads the faces around a vertex; false if they have no common direction or their error leaves no room.
bool StarCollapser::gather(std::int32_t from, double limit) {
  const Star& star = stars_[from];
  const std::int32_t* const around_from = around(from);
  count_ = star.count;
  const Vec3& p = mesh_.vertices[star.vertex];
  Vec3 sum(0);
  float worst = 0;
  for (int n = 0; n < count_; ++n) {
    const Face& face = faces_[around_from[n]];
    Side& side = sides_[n];
    // Without branches, because which corner it is cannot be predicted.
    const std::int32_t corners[5] = {face.v.x, face.v.y, face.v.z, face.v.x, face.v.y};
    const int at = (face.v.y == star.vertex ? 1 : 0) + (face.v.z == star.vertex ? 2 : 0);
    side.a = corners[at + 1], side.b = corners[at + 2];
    side.pa = mesh_.vertices[side.a] - p, side.pb = mesh_.vertices[side.b] - p;
    side.normal = face.normal;
    sum += face.normal;
    worst = std::max(worst, face.error);
  }
  base_ = worst;
  if (!(base_ < limit)) return false;
  const double length = glm::length(sum);
  if (!(length > kFacing * count_)) return false;
  direction_ = sum / length;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (int n = 0; n < count_; ++n) {
    if (!(glm::dot(sides_[n].normal, direction_) > kFacing)) return false;
    const double h = glm::dot(sides_[n].pa, direction_);
    sides_[n].height = h;
    low = std::min(low, h), high = std::max(high, h);
  }
  slab_ = std::max(high, 0.0) - std::min(low, 0.0);
  least_ = std::max({low, -high, 0.0});
  has_ring_ = false;
  return true;
}

bool StarCollapser::merge(std::int32_t from, double limit, int most_faces) {
  Star& star = stars_[from];
  if (star.count < 3 || star.needs > limit) return false;
  star.needs = std::numeric_limits<double>::infinity();
  if (!gather(from, most_error_)) return false;
  if (!(base_ + least_ <= limit)) {
    if (base_ + least_ <= most_error_) star.needs = base_ + least_;
    return false;
  }
  // Along a groove nothing is lost; where all is flat the nearest is best.
  std::array<Target, kTargets + 1> targets;
  int many = 0;
  for (int n = 0; n < count_; ++n) {
    const std::int32_t s = slot(sides_[n].a);
    if (s < 0 || stars_[s].locked) continue;
    const int faces = stars_[s].count + count_ - 4;
    if (faces < 3 || faces > most_faces) continue;
    const Target found{std::abs(sides_[n].height) + kNear * glm::length(sides_[n].pa), n};
    int at = many;
    for (; at > 0 && found.guess < targets[at - 1].guess; --at) targets[at] = targets[at - 1];
    targets[at] = found;
    many = std::min(many + 1, kTargets);
  }
  const bool flat = slab_ <= tolerance_ * kFlat && base_ + slab_ <= most_error_;
  double error_taken = 0, lowest = std::numeric_limits<double>::infinity();
  int taken = -1;
  for (int n = 0; n < many; ++n) {
    const Side& to = sides_[targets[n].side];
    // Above the room that is left, the error may be incomplete, also where the sum rounds down to the limit.
    const double room = limit - base_, error = flat ? slab_ : error_of(to, room);
    if (!(error <= room && base_ + error <= limit)) {
      lowest = std::min(lowest, error);
      continue;
    }
    if (!keeps_shape(to)) continue;
    std::int32_t x = -1, y = to.b;
    for (int m = 0; m < count_; ++m)
      if (sides_[m].b == to.a) x = sides_[m].a;
    if (!keeps_manifold(from, slot(to.a), x, y)) continue;
    error_taken = error, taken = targets[n].side;
    break;
  }
  if (taken < 0) {
    if (base_ + lowest <= most_error_) star.needs = base_ + lowest;
    return false;
  }
  if (folds(from, sides_[taken])) return false;
  commit(from, slot(sides_[taken].a), error_taken, limit);
  return true;
}

/// Whether the new triangles face along the direction, turn little and are not too thin.
bool StarCollapser::keeps_shape(const Side& to) {
  for (int n = 0; n < count_; ++n) {
    const Side& side = sides_[n];
    if (side.a == to.a || side.b == to.a) continue;
    const Vec3 a = side.pa - to.pa, b = side.pb - to.pa;
    const Vec3 cross = glm::cross(a, b);
    const double area = squared(cross);
    const double longest = std::max({squared(a), squared(b), squared(a - b)});
    if (!(area > kThinnest * kThinnest * longest * longest)) return false;
    const double facing = glm::dot(cross, direction_), turned = glm::dot(cross, side.normal);
    if (!(facing > 0 && facing * facing > kFacing * kFacing * area)) return false;
    if (!(turned > 0 && turned * turned > kTurn * kTurn * area)) return false;
  }
  return true;
}

/// Whether a new triangle would lie on its neighbour across a side that has a vertex of the group.
bool StarCollapser::folds(std::int32_t from, const Side& to) const {
  for (int n = 0; n < count_; ++n) {
    const Side& side = sides_[n];
    if (side.a == to.a || side.b == to.a) continue;
    const std::int32_t slots[2] = {slot(side.a), slot(side.b)};
    if (is_calm(slots[0]) || is_calm(slots[1])) continue;
    const Vec3 cross = glm::cross(side.pa - to.pa, side.pb - to.pa);
    const double length = glm::length(cross);
    // Looks among the faces around one end of the side for the other end.
    const auto faces_away = [&](std::int32_t s, std::int32_t end, bool& found) {
      if (s < 0) return false;
      for (int m = 0; m < stars_[s].count; ++m) {
        const Face& face = faces_[around(s)[m]];
        const auto has = [&](std::int32_t v) { return (face.v.x == v) | (face.v.y == v) | (face.v.z == v); };
        if (!has(end) || has(stars_[from].vertex)) continue;
        found = true;
        return glm::dot(face.normal, cross) < kTouching * length;
      }
      return false;
    };
    bool found = false;
    if (faces_away(slots[0], side.b, found) || (!found && faces_away(slots[1], side.a, found))) return true;
  }
  return false;
}

bool StarCollapser::keeps_manifold(std::int32_t from, std::int32_t to, std::int32_t x, std::int32_t y) const {
  // Most of the other vertex's faces have no vertex that equals one of this one's neighbours in the last bits.
  const std::int32_t target = stars_[to].vertex;
  std::uint64_t near = 0;
  for (int n = 0; n < count_; ++n) {
    const std::int32_t w = sides_[n].a;
    if ((w != x) & (w != y) & (w != target)) near |= std::uint64_t{1} << (w & 63);
  }
  for (int n = 0; n < stars_[to].count; ++n) {
    const Vec3i& v = faces_[around(to)[n]].v;
    const auto has = [&](std::int32_t w) { return (v.x == w) | (v.y == w) | (v.z == w); };
    if (has(x) & has(y)) return false;  // of a tetrahedron
    if (!((near >> (v.x & 63) | near >> (v.y & 63) | near >> (v.z & 63)) & 1)) continue;
    for (const std::int32_t w : {v.x, v.y, v.z}) {
      if (!(near >> (w & 63) & 1) || w == x || w == y || w == stars_[to].vertex || w == stars_[from].vertex) continue;
      for (int m = 0; m < count_; ++m)
        if (sides_[m].a == w) return false;
    }
  }
  // A vertex with three faces would keep two.
  for (const std::int32_t apex : {x, y})
    if (const std::int32_t s = slot(apex); s >= 0 && !stars_[s].locked && stars_[s].count < 4) return false;
  return true;
}

/// Lists the vertices around the old one in order, twice, in the frame of the direction.
void StarCollapser::turn_ring() {
  const Vec3& n = direction_;
  const Vec3 e = glm::normalize(std::abs(n.x) < 0.6 ? Vec3(0, n.z, -n.y) : Vec3(-n.z, 0, n.x));
  const Vec3 f = glm::cross(n, e);
  for (int k = 0, side = 0; k < count_; ++k) {
    const Vec3& p = sides_[side].pa;
    ring_[k] = ring_[k + count_] = {glm::dot(p, e), glm::dot(p, f), sides_[side].height};
    place_in_ring_[side] = k;
    int next = 0;
    while (next < count_ && sides_[next].a != sides_[side].b) ++next;
    side = next;
  }
  has_ring_ = true;
}

/// The largest distance of the old and the new triangles along the direction, or any distance above `enough`. All old
/// and new triangles must face along it.
double StarCollapser::error_of(const Side& to, double enough) {
  if (!has_ring_) turn_ring();
  // The new triangles are (q[0], q[k], q[k + 1]), the old ones (0, q[k], q[k + 1]).
  const Vec3* const q = ring_.data() + place_in_ring_[&to - sides_.data()];
  const Vec3& u = q[0];
  std::array<double, kMostFaces> turned;
  for (int k = 1; k < count_; ++k) turned[k] = turn(u, q[k]);
  // The old vertex over its new triangle: the cheapest test first.
  double error = slab_;
  bool covered = false;
  for (int k = 1; k + 1 < count_ && !covered; ++k) {
    if (!(turned[k] >= 0 && turned[k + 1] <= 0)) continue;
    const double wu = turn(q[k], q[k + 1]), wa = -turned[k + 1], wb = turned[k];
    const double sum = wu + wa + wb;
    if (!(wu >= 0 && sum > 0)) continue;
    error = std::abs(wu * u.z + wa * q[k].z + wb * q[k + 1].z) / sum;
    covered = true;
  }
  if (!covered) return error;
  // Each new edge crosses the old ones on its side of the old vertex.
  for (int k = 2; k + 1 < count_ && !(error > enough); ++k) {
    const bool left = turned[k] > 0;
    const double rise = q[k].z - u.z;
    for (int m = left ? 1 : k + 1; m < (left ? k : count_); ++m) {
      const double across = turn(q[m], q[k]) + turned[m];
      if (across == 0) continue;
      const double gap = std::abs(u.z * across + turned[m] * rise - turned[k] * q[m].z), width = std::abs(across);
      if (gap > error * width) error = gap / width;
    }
  }
  return error;
}

void StarCollapser::drop(std::int32_t vertex, std::int32_t face) {
  const std::int32_t s = slot(vertex);
  if (s < 0 || stars_[s].locked) return;
  std::int32_t* const faces = around(s);
  std::int32_t* const end = faces + stars_[s].count--;
  std::int32_t* const at = std::find(faces, end, face);
  std::copy(at + 1, end, at);
}

void StarCollapser::commit(std::int32_t from, std::int32_t to, double error, double limit) {
  const std::int32_t* const gone = around(from);
  const std::int32_t kept = stars_[to].vertex;
  const float bound = rounded_up(base_ + error);
  stars_[from].count = 0;
  for (int n = 0; n < count_; ++n) {
    const std::int32_t f = gone[n];
    const Side& side = sides_[n];
    if (side.a != kept && side.b != kept) continue;
    drop(side.a, f), drop(side.b, f);
    faces_[f].v = Vec3i(-1);
  }
  for (int n = 0; n < count_; ++n) {
    const std::int32_t f = gone[n];
    Face& face = faces_[f];
    const Side& side = sides_[n];
    if (side.a == kept || side.b == kept) continue;
    face.v = {kept, side.a, side.b};
    const Vec3 &p = mesh_.vertices[kept], &a = mesh_.vertices[side.a], &b = mesh_.vertices[side.b];
    face.normal = glm::normalize(glm::cross(a - p, b - p));
    face.error = bound;
    around(to)[stars_[to].count++] = f;
    for (const std::int32_t s : {to, slot(side.a), slot(side.b)}) see_normal(s, face.normal);
  }
  const auto again = [&](std::int32_t s) {
    if (s < 0) return;
    Star& star = stars_[s];
    if (star.needs == std::numeric_limits<double>::infinity()) star.needs = limit * 1.001;
    if (star.needs > limit || star.queued || star.locked) return;
    star.queued = true;
    queue_.push_back(s);
  };
  for (int n = 0; n < count_; ++n) again(slot(sides_[n].a));
}

}  // namespace riffler::mesh
