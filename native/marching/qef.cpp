#include "marching/qef.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace riffler::marching {

namespace {

constexpr double kGroup = 0.35;
constexpr double kRound = 0.9;     // fraction of the distance to the tangent planes where the surface bends tightly
constexpr double kDamping = 0.01;  // λ of the stepwise solution: directions that no plane constrains stay near the mean
constexpr double kAnchor = 1e-2;   // weight of the distance to the mean, in the box

/// Whether unit normals form two or three groups: within a group, no normal is farther from the next than kGroup times
/// the distance between groups. The steps of the minimum spanning tree (Prim's) show it.
bool in_groups(const Tangents& hits) {
  std::array<double, 12> away{}, steps{};  // distance of each normal from the tree; steps of the tree
  std::array<bool, 12> in{};
  away.fill(std::numeric_limits<double>::infinity());
  for (int last = 0, count = 0; count + 1 < hits.count; ++count) {
    in[last] = true;
    int next = -1;
    for (int i = 0; i < hits.count; ++i) {
      if (in[i]) continue;
      away[i] = std::min(away[i], glm::length(hits.normal[i] - hits.normal[last]));
      if (next < 0 || away[i] < away[next]) next = i;
    }
    steps[count] = away[next], last = next;
  }
  std::sort(steps.begin(), steps.begin() + hits.count - 1, std::greater<>());
  return steps[1] <= kGroup * steps[0] || steps[2] <= kGroup * steps[1];
}

/// Solves the rows and columns in `free` of a x = r, for a symmetric positive definite `a`; x holds the other
/// components.
void solve_free(const Mat3& a, const Vec3& r, int free, Vec3& x) {
  int axis[3], n = 0;
  for (int d = 0; d < 3; ++d)
    if (free >> d & 1) axis[n++] = d;
  double m[3][4];
  for (int row = 0; row < n; ++row) {
    m[row][3] = r[axis[row]];
    for (int d = 0; d < 3; ++d)
      if (!(free >> d & 1)) m[row][3] -= a[axis[row]][d] * x[d];
    for (int column = 0; column < n; ++column) m[row][column] = a[axis[row]][axis[column]];
  }
  for (int p = 0; p < n; ++p)
    for (int row = p + 1; row < n; ++row) {
      const double f = m[row][p] / m[p][p];
      for (int column = p + 1; column < n; ++column) m[row][column] -= f * m[p][column];
      m[row][3] -= f * m[p][3];
    }
  for (int p = n - 1; p >= 0; --p) {
    double sum = m[p][3];
    for (int column = p + 1; column < n; ++column) sum -= m[p][column] * x[axis[column]];
    x[axis[p]] = sum / m[p][p];
  }
}

}  // namespace

Qef::Qef(const Tangents& tangents) : hits_(tangents) {
  for (int i = 0; i < hits_.count; ++i) {
    const Vec3 &p = hits_.point[i], &n = hits_.normal[i];
    mean_ += p, mean_normal_ += n;
    a_ += glm::outerProduct(n, n);
    b_ += n * glm::dot(n, p);
  }
  const double share = 1.0 / hits_.count;
  mean_ *= share, mean_normal_ *= share, a_ *= share, b_ *= share;
  const bool smooth = glm::dot(mean_normal_, mean_normal_) > kSmooth;
  bend_ = smooth ? Bend::Smooth : in_groups(hits_) ? Bend::Sharp : Bend::Round;
}

Vec3 Qef::solve() const {
  if (bend_ != Bend::Sharp) {
    // On a sphere the tangent planes err by +d²/2R and the mean of the hits by −d²/2R: half way they cancel. If the
    // radius is not much larger than a cell, triangles cut off more than vertices stick out.
    const double part = bend_ == Bend::Round ? kRound : 0.5;
    const Vec3 g = glm::normalize(mean_normal_);
    double distance = 0, slope = 0;
    for (int i = 0; i < hits_.count; ++i) {
      distance += glm::dot(hits_.normal[i], hits_.point[i] - mean_);
      slope += glm::dot(hits_.normal[i], g);
    }
    return mean_ + g * (part * distance / slope);
  }
  const Mat3 inverse = glm::inverse(a_ + Mat3(kDamping));
  Vec3 x = mean_;
  for (int step = 0; step < 3; ++step) x += inverse * (b_ - a_ * x);
  return x;
}

Vec3 Qef::solve_in(const Box3& box) const {
  // The function is strictly convex, so the smallest of the feasible stationary points over all 27 sets of active
  // bounds is the minimum. (Coordinate descent would slide along a feature and stop early.)
  const Mat3 a = a_ + Mat3(kAnchor);
  const Vec3 r = b_ + kAnchor * mean_;
  Vec3 best = glm::clamp(mean_, box.lower, box.upper);
  double least = std::numeric_limits<double>::infinity();
  for (int set = 0; set < 27; ++set) {
    const int bound[3] = {set % 3, set / 3 % 3, set / 9};
    Vec3 x{0, 0, 0};
    int free = 0;
    for (int d = 0; d < 3; ++d) {
      if (bound[d] == 0)
        free |= 1 << d;
      else
        x[d] = bound[d] == 1 ? box.lower[d] : box.upper[d];
    }
    solve_free(a, r, free, x);
    bool feasible = true;
    for (int d = 0; d < 3; ++d) feasible = feasible && x[d] >= box.lower[d] && x[d] <= box.upper[d];
    const double value = glm::dot(x, a * x - 2.0 * r);
    if (feasible && value < least) least = value, best = x;
  }
  return best;
}

double Qef::residual(const Vec3& x) const {
  double sum = 0;
  for (int i = 0; i < hits_.count; ++i) {
    const double d = glm::dot(hits_.normal[i], x - hits_.point[i]);
    sum += d * d;
  }
  return std::sqrt(sum / hits_.count);
}

}  // namespace riffler::marching
