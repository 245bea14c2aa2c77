#include "mesh/surface_samples.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace riffler {

namespace {

using OpenMesh::HalfedgeHandle;

/// The share of the tolerance that flat fans may use up by dropping their samples.
constexpr double kFlatShare = 0.1;

/// Where segments ab and cd cross seen along n: the parameters on both; false where they do not.
bool crossing(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& n, double& s, double& t) {
  const Vec3 ab = b - a, cd = d - c, ac = c - a;
  const double det = glm::dot(n, glm::cross(ab, cd));
  if (det == 0) return false;
  s = glm::dot(n, glm::cross(ac, cd)) / det;
  t = glm::dot(n, glm::cross(ac, ab)) / det;
  return s > 0 && s < 1 && t > 0 && t < 1;
}

}  // namespace

SurfaceSamples::SurfaceSamples(const Mesh& original, const HalfEdgeMesh& mesh, double tolerance)
    : mesh_(mesh),
      tolerance_(tolerance),
      original_(original),
      head_(mesh.n_faces(), -1),
      error_(mesh.n_faces(), 0.0),
      changed_(mesh.n_edges(), 0) {}

bool SurfaceSamples::allow(const Collapse& c) {
  fan_error_ = 0;
  for (int i = 0; i < c.old_faces(); ++i) fan_error_ = std::max(fan_error_, error_[c.face(i).idx()]);
  limit_ = tolerance_ - fan_error_;
  moves_.clear();
  largest_ = 0;
  if (!near_new_faces(c, c.old_point(), -1) || !middles_near(c)) return false;
  for (int i = 0; i < c.old_faces(); ++i)
    for (int k = head_[c.face(i).idx()]; k >= 0; k = samples_[k].next)
      if (!near_new_faces(c, samples_[k].point, k)) return false;
  find_normal(c);
  // Old and new fan fill the same part of a slab: no point of one is farther from the other than it is thick.
  flat_error_ = fan_error_ + std::max(largest_, thickness_);
  flat_ = flat_error_ <= kFlatShare * tolerance_ && !c.on_border();
  return flat_ || (spokes_near(c) && border_near(c));
}

bool SurfaceSamples::near_new_faces(const Collapse& c, const Vec3& point, int index) {
  double best = std::numeric_limits<double>::infinity();
  int face = -1;
  for (int i = c.first(); i <= c.last(); ++i) {
    const Vec3 d = point - closest_on_triangle(point, c.new_point(), c.ring(i), c.ring(i + 1)).point;
    if (const double d2 = glm::dot(d, d); d2 < best) best = d2, face = i;
  }
  if (!(best <= limit_ * limit_)) return false;
  largest_ = std::max(largest_, std::sqrt(best));
  moves_.push_back({point, index, c.face(face).idx()});
  return true;
}

bool SurfaceSamples::middles_near(const Collapse& c) {
  for (int i = 0; i < c.ring_size(); ++i)
    if (i != c.target() && is_original(c.spoke(i)) && !near_new_faces(c, 0.5 * (c.old_point() + c.ring(i)), -1))
      return false;
  return true;
}

/// The direction along which both fans are seen best, and how thick a slab across it holds them; infinite where a face
/// turns away from it.
void SurfaceSamples::find_normal(const Collapse& c) {
  normal_ = Vec3(0);
  for (int i = 0; i < c.old_faces(); ++i) normal_ += c.old_cross(i) + c.new_cross(i);
  const double length = glm::length(normal_);
  if (length > 0) normal_ /= length;
  double low = glm::dot(normal_, c.old_point()), high = low;
  for (int i = 0; i < c.ring_size(); ++i) {
    const double height = glm::dot(normal_, c.ring(i));
    low = std::min(low, height), high = std::max(high, height);
  }
  thickness_ = high - low;
  for (int i = 0; i < c.old_faces(); ++i)
    if (glm::dot(c.old_cross(i), normal_) < 0 || glm::dot(c.new_cross(i), normal_) < 0)
      thickness_ = std::numeric_limits<double>::infinity();
}

bool SurfaceSamples::spokes_near(const Collapse& c) const {
  for (int i = c.first() + 1; i <= c.last(); ++i)
    if (!spoke_near(c, i, normal_)) return false;
  return true;
}

/// New edge `to` – ring(i) against the old edges `from` – ring(j).
bool SurfaceSamples::spoke_near(const Collapse& c, int i, const Vec3& normal) const {
  const Vec3& end = c.ring(i);
  for (int j = 0; j < c.ring_size(); ++j) {
    double s, t;
    if (j == i || j == c.target() || !crossing(c.new_point(), end, c.old_point(), c.ring(j), normal, s, t)) continue;
    const Vec3 on_new = c.new_point() + s * (end - c.new_point());
    const Vec3 on_old = c.old_point() + t * (c.ring(j) - c.old_point());
    if (is_original(c.spoke(j)) && glm::length(on_new - on_old) <= limit_) continue;
    if (!original_.within(on_new, limit_)) return false;
  }
  return true;
}

/// A border may not run away from the old surface either.
bool SurfaceSamples::border_near(const Collapse& c) const {
  if (!c.on_border()) return true;
  const Vec3& other = c.ring(c.target() == 0 ? c.ring_size() - 1 : 0);
  for (const double s : {0.125, 0.375, 0.5, 0.625, 0.875})
    if (!original_.within(c.new_point() + s * (other - c.new_point()), limit_)) return false;
  return true;
}

void SurfaceSamples::commit(const Collapse& c) {
  for (int i = 0; i < c.old_faces(); ++i) {
    head_[c.face(i).idx()] = -1;
    error_[c.face(i).idx()] = flat_ ? flat_error_ : fan_error_;
  }
  // With its samples dropped the new fan stands for the old surface, and so do its edges.
  for (int i = c.first() + 1; i <= c.last(); ++i) changed_[c.spoke(i).idx() / 2] = flat_ ? 0 : 1;
  if (c.on_border()) changed_[c.spoke(c.target() == 0 ? c.ring_size() - 1 : 0).idx() / 2] = 1;
  if (flat_) return;
  for (const Move& move : moves_) {
    int index = move.index;
    if (index < 0) index = static_cast<int>(samples_.size()), samples_.push_back({move.point, -1});
    samples_[index].next = head_[move.face];
    head_[move.face] = index;
  }
}

}  // namespace riffler
