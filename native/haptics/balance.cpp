#include "riffler/haptics/balance.hpp"

#include <algorithm>
#include <cmath>

#include "geom/math.hpp"

namespace riffler::haptics {

namespace {

constexpr std::size_t kMostFreedoms = 5;  // a body of revolution has three translations and two rotations

/// Derivative of e_i · (v + ω × arm) with respect to coordinate k of (v, ω).
double moved_by(std::size_t i, std::size_t k, const Vec3& arm) {
  if (k < 3) return i == k ? 1 : 0;
  Vec3 turn(0);
  turn[static_cast<int>(k - 3)] = 1;
  return glm::cross(turn, arm)[static_cast<int>(i)];
}

}  // namespace

void Balance::add_spring(double linear, double angular, const Twist& stretch) {
  for (std::size_t k = 0; k < 6; ++k) matrix_[k][k] += k < 3 ? linear : angular;
  pull_ = pull_ + Wrench{linear * stretch.linear, angular * stretch.angular};
}

void Balance::add_damper(const Damper& d, const Twist& moving) {
  const double linear = d.linear / dt_, angular = d.angular / dt_;
  for (std::size_t k = 0; k < 6; ++k)
    for (std::size_t l = 0; l < 6; ++l)
      for (std::size_t i = 0; i < 3; ++i) matrix_[k][l] += linear * moved_by(i, k, d.arm) * moved_by(i, l, d.arm);
  for (std::size_t k = 3; k < 6; ++k) matrix_[k][k] += angular;
  const Vec3 force = d.linear * moving.linear;
  pull_ = pull_ + Wrench{force, glm::cross(d.arm, force) + d.angular * moving.angular};
}

void Balance::add_contact(const Wrench& wrench, const collide::ContactStiffness& stiffness) {
  for (std::size_t k = 0; k < 6; ++k)
    for (std::size_t l = 0; l < 6; ++l) matrix_[k][l] += stiffness[k][l];
  pull_ = pull_ + wrench;
}

Twist Balance::solve() const {
  const Vec3 u = geom::any_perpendicular(axis_), v = glm::cross(axis_, u);
  const std::array<Twist, kMostFreedoms> freedoms{Twist{{1, 0, 0}, {}}, Twist{{0, 1, 0}, {}}, Twist{{0, 0, 1}, {}},
                                                  Twist{{}, u}, Twist{{}, v}};
  return solve(freedoms);
}

Twist Balance::solve(std::span<const Twist> freedoms, const Twist& given) const {
  Wrench pull = pull_;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) pull[i] -= matrix_[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] * given[j];
  const std::size_t free = std::min(freedoms.size(), kMostFreedoms);
  double a[kMostFreedoms][kMostFreedoms]{}, x[kMostFreedoms]{};
  for (std::size_t r = 0; r < free; ++r) {
    for (int i = 0; i < 6; ++i) x[r] += freedoms[r][i] * pull[i];
    for (std::size_t c = 0; c < free; ++c)
      for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t j = 0; j < 6; ++j)
          a[r][c] += freedoms[r][static_cast<int>(i)] * matrix_[i][j] * freedoms[c][static_cast<int>(j)];
  }
  // In-place Cholesky decomposition. A coordinate that nothing holds stays 0.
  for (std::size_t j = 0; j < free; ++j) {
    const double before = a[j][j];
    for (std::size_t k = 0; k < j; ++k) a[j][j] -= a[j][k] * a[j][k];
    const bool held = a[j][j] > 1e-14 * before;
    const double root = held ? std::sqrt(a[j][j]) : 1;
    a[j][j] = root;
    for (std::size_t i = j + 1; i < free; ++i) {
      for (std::size_t k = 0; k < j; ++k) a[i][j] -= a[i][k] * a[j][k];
      a[i][j] = held ? a[i][j] / root : 0;
    }
    if (!held) x[j] = 0;
    for (std::size_t k = 0; k < j && held; ++k) x[j] -= a[j][k] * x[k];
    x[j] /= root;
  }
  for (std::size_t j = free; j-- > 0;) {
    for (std::size_t k = j + 1; k < free; ++k) x[j] -= a[k][j] * x[k];
    x[j] /= a[j][j];
  }
  Twist out = given;
  for (std::size_t j = 0; j < free; ++j) out = out + x[j] * freedoms[j];
  return finite(out) ? out : Twist{};
}

}  // namespace riffler::haptics
