#include "riffler/haptics/balance.hpp"

#include <cmath>

#include "geom/math.hpp"

namespace riffler::haptics {

namespace {

constexpr std::size_t kFree = 5;

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
  // Three translations and the two rotations orthogonal to the axis: basis · coordinates.
  const Vec3 u = geom::any_perpendicular(axis_), v = glm::cross(axis_, u);
  double basis[6][kFree]{};
  for (std::size_t i = 0; i < 3; ++i) {
    basis[i][i] = 1;
    basis[i + 3][3] = u[static_cast<int>(i)], basis[i + 3][4] = v[static_cast<int>(i)];
  }
  double a[kFree][kFree]{}, x[kFree]{};
  for (std::size_t r = 0; r < kFree; ++r) {
    for (std::size_t i = 0; i < 6; ++i) x[r] += basis[i][r] * pull_[static_cast<int>(i)];
    for (std::size_t c = 0; c < kFree; ++c)
      for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t j = 0; j < 6; ++j) a[r][c] += basis[i][r] * matrix_[i][j] * basis[j][c];
  }
  // In-place Cholesky decomposition. A coordinate that nothing holds stays 0.
  for (std::size_t j = 0; j < kFree; ++j) {
    const double before = a[j][j];
    for (std::size_t k = 0; k < j; ++k) a[j][j] -= a[j][k] * a[j][k];
    const bool held = a[j][j] > 1e-14 * before;
    const double root = held ? std::sqrt(a[j][j]) : 1;
    a[j][j] = root;
    for (std::size_t i = j + 1; i < kFree; ++i) {
      for (std::size_t k = 0; k < j; ++k) a[i][j] -= a[i][k] * a[j][k];
      a[i][j] = held ? a[i][j] / root : 0;
    }
    if (!held) x[j] = 0;
    for (std::size_t k = 0; k < j && held; ++k) x[j] -= a[j][k] * x[k];
    x[j] /= root;
  }
  for (std::size_t j = kFree; j-- > 0;) {
    for (std::size_t k = j + 1; k < kFree; ++k) x[j] -= a[k][j] * x[k];
    x[j] /= a[j][j];
  }
  const Twist out{{x[0], x[1], x[2]}, x[3] * u + x[4] * v};
  return finite(out) ? out : Twist{};
}

}  // namespace riffler::haptics
