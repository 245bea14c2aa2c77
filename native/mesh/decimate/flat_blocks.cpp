// Blocks of flat triangles become a fan at once: nearly all of most meshes.
#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/decimate/star_collapse.hpp"

namespace riffler::mesh {

namespace {

constexpr std::ptrdiff_t kFewest = 12;    // vertices of a block
constexpr std::ptrdiff_t kSamples = 16;   // of its vertices, looked at first
constexpr double kParallel = 1 - 5e-7;    // cosine of a flat block's normals
constexpr double kFlatShare = 1.0 / 256;  // thickness of a flat block over the tolerance

}  // namespace

/// Removes all but one of the vertices of a flat block; halves a block that is not flat.
void StarCollapser::flatten(std::int32_t* begin, std::int32_t* end) {
  if (end - begin < kFewest) return;
  Flat flat;
  ++stamp_;
  if (is_flat(begin, end, flat) && find_rim(begin, end) && fan(begin, end, flat)) return;
  Box3 box;
  for (const std::int32_t* s = begin; s != end; ++s) box.add(mesh_.vertices[stars_[*s].vertex]);
  const Vec3 size = box.upper - box.lower, middle = 0.5 * (box.lower + box.upper);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  std::int32_t* const half = std::stable_partition(
      begin, end, [&](std::int32_t s) { return mesh_.vertices[stars_[s].vertex][axis] < middle[axis]; });
  if (half == begin || half == end) return;
  flatten(begin, half), flatten(half, end);
}

/// Whether all faces around the block's vertices lie in one plane, nearly.
bool StarCollapser::is_flat(const std::int32_t* begin, const std::int32_t* end, Flat& flat) {
  const Vec3 first = faces_[around(*begin)[0]].normal;
  // Most blocks that are not flat show it at a few vertices.
  const std::ptrdiff_t step = (end - begin) / kSamples + 1;
  for (const std::int32_t* s = end - 1; s > begin; s -= std::min(step, s - begin))
    if (!(glm::dot(faces_[around(*s)[0]].normal, first) > kParallel)) return false;
  Vec3 sum(0);
  float error = 0;
  inside_.clear();
  for (const std::int32_t* s = begin; s != end; ++s) {
    stars_[*s].stamp = stamp_;
    const std::int32_t* const faces = around(*s);
    for (int n = 0; n < stars_[*s].count; ++n) {
      Face& face = faces_[faces[n]];
      if (face.stamp == stamp_) continue;
      if (!(glm::dot(face.normal, first) > kParallel)) return false;
      face.stamp = stamp_;
      sum += face.normal;
      error = std::max(error, face.error);
      inside_.push_back(faces[n]);
    }
  }
  flat.direction = glm::normalize(sum);
  const Vec3 origin = mesh_.vertices[stars_[*begin].vertex];
  double low = 0, high = 0;
  for (const std::int32_t f : inside_)
    for (const std::int32_t v : {faces_[f].v.x, faces_[f].v.y, faces_[f].v.z}) {
      const double h = glm::dot(mesh_.vertices[v] - origin, flat.direction);
      low = std::min(low, h), high = std::max(high, h);
    }
  flat.slab = high - low, flat.error = error;
  return flat.slab <= kFlatShare * most_error_ && error + flat.slab <= most_error_;
}

/// The edges opposite to the block's vertices; false unless its faces form a disc.
bool StarCollapser::find_rim(const std::int32_t* begin, const std::int32_t* end) {
  const auto inner = [&](std::int32_t v) {
    const std::int32_t s = slot(v);
    return s >= 0 && stars_[s].stamp == stamp_;
  };
  rim_.clear();
  for (const std::int32_t f : inside_) {
    const Vec3i& v = faces_[f].v;
    const bool x = inner(v.x), y = inner(v.y), z = inner(v.z);
    if (x + y + z != 1) continue;
    rim_.push_back(x ? RimEdge{v.y, v.z} : y ? RimEdge{v.z, v.x} : RimEdge{v.x, v.y});
  }
  const auto rim = static_cast<std::ptrdiff_t>(rim_.size());
  // Euler's formula for a disc.
  if (rim < 3 || rim > kMostFaces || static_cast<std::ptrdiff_t>(inside_.size()) != 2 * (end - begin) + rim - 2)
    return false;
  std::sort(rim_.begin(), rim_.end());
  std::int32_t at = rim_[0].a;
  for (std::ptrdiff_t n = 0; n < rim; ++n) {
    if (n > 0 && rim_[n].a == rim_[n - 1].a) return false;
    const auto next = std::lower_bound(rim_.begin(), rim_.end(), RimEdge{at, 0});
    if (next == rim_.end() || next->a != at) return false;
    at = next->b;
    if (at == rim_[0].a) return n + 1 == rim && fits_rim();
  }
  return false;
}

/// Whether the vertices of the rim have room for their new faces.
bool StarCollapser::fits_rim() const {
  return std::all_of(rim_.begin(), rim_.end(), [&](const RimEdge& e) {
    const std::int32_t s = slot(e.a);
    return s < 0 || stars_[s].locked || stars_[s].count < kMostFaces;
  });
}

/// Replaces the block's faces by a fan around its vertex nearest to the middle of the rim.
bool StarCollapser::fan(const std::int32_t* begin, const std::int32_t* end, const Flat& flat) {
  Vec3 middle(0);
  for (const RimEdge& e : rim_) middle += mesh_.vertices[e.a];
  middle /= static_cast<double>(rim_.size());
  std::int32_t kept = *begin;
  double nearest = std::numeric_limits<double>::infinity();
  for (const std::int32_t* s = begin; s != end; ++s) {
    const Vec3 d = mesh_.vertices[stars_[*s].vertex] - middle;
    if (const double distance = glm::dot(d, d); distance < nearest) nearest = distance, kept = *s;
  }
  const Vec3& c = mesh_.vertices[stars_[kept].vertex];
  for (const RimEdge& e : rim_) {
    const Vec3 a = mesh_.vertices[e.a] - c, b = mesh_.vertices[e.b] - c;
    const Vec3 cross = glm::cross(a, b);
    const double area = glm::dot(cross, cross);
    const double longest = std::max({glm::dot(a, a), glm::dot(b, b), glm::dot(a - b, a - b)});
    if (!(area > kThinnest * kThinnest * longest * longest)) return false;
    const double facing = glm::dot(cross, flat.direction);
    if (!(facing > 0 && facing * facing > kTurn * kTurn * area)) return false;
  }
  for (const RimEdge& e : rim_) {
    const std::int32_t s = slot(e.a);
    if (s < 0 || stars_[s].locked) continue;
    std::int32_t* const faces = around(s);
    const auto old = [&](std::int32_t f) { return faces_[f].stamp == stamp_; };
    stars_[s].count = static_cast<std::uint8_t>(std::remove_if(faces, faces + stars_[s].count, old) - faces);
  }
  for (const std::int32_t* s = begin; s != end; ++s) stars_[*s].count = 0;
  const float bound = rounded_up(flat.error + flat.slab);
  for (std::size_t n = 0; n < inside_.size(); ++n) {
    Face& face = faces_[inside_[n]];
    if (n >= rim_.size()) {
      face.v = Vec3i(-1);
      continue;
    }
    face.v = {stars_[kept].vertex, rim_[n].a, rim_[n].b};
    const Vec3 &a = mesh_.vertices[face.v.y], &b = mesh_.vertices[face.v.z];
    face.normal = glm::normalize(glm::cross(a - c, b - c));
    face.error = bound;
    for (const std::int32_t v : {face.v.x, face.v.y, face.v.z}) {
      const std::int32_t s = slot(v);
      see_normal(s, face.normal);
      if (s >= 0 && !stars_[s].locked) around(s)[stars_[s].count++] = inside_[n];
    }
  }
  return true;
}

}  // namespace riffler::mesh
