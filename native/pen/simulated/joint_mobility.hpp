// The six joints of the pen's two arms as one vector: how the grip moves with them, and how they move under torques
// while the grip keeps its length.
#pragma once

#include <array>
#include <cmath>

#include "riffler/pen/arms/kinematics.hpp"

namespace riffler::pen {

inline constexpr std::size_t kJoints = 6;
using JointVector = std::array<double, kJoints>;  // θ1 θ2 θ3 of R, then of L

inline double dot(const JointVector& a, const JointVector& b) {
  double sum = 0;
  for (std::size_t k = 0; k < kJoints; ++k) sum += a[k] * b[k];
  return sum;
}

/// Jacobian of the joints: columns for the grip's middle and for r_L − r_R, base frame.
struct JointReach {
  std::array<Vec3, kJoints> middle, apart;
  Vec3 along;
  double length;

  explicit JointReach(const PenPosture& posture) : along(posture.apart / posture.length), length(posture.length) {
    for (std::size_t k = 0; k < kJoints; ++k) {
      const Vec3 column = posture.arms[k / 3].jacobian[static_cast<int>(k % 3)];
      middle[k] = 0.5 * column;
      apart[k] = k < 3 ? -column : column;
    }
  }
  Vec3 of_middle(const JointVector& v) const { return sum(middle, v); }
  Vec3 of_apart(const JointVector& v) const { return sum(apart, v); }
  /// Gradient of the grip's length.
  JointVector stretch() const {
    JointVector out;
    for (std::size_t k = 0; k < kJoints; ++k) out[k] = glm::dot(along, apart[k]);
    return out;
  }
  /// Transposed Jacobian times a mass at the middle, and times an inertia of `turning` / length² for motion of the ends
  /// apart.
  JointVector back(double mass, const Vec3& of_middle, double turning, const Vec3& of_apart) const {
    JointVector out;
    for (std::size_t k = 0; k < kJoints; ++k)
      out[k] = mass * glm::dot(middle[k], of_middle) + turning / (length * length) * glm::dot(apart[k], of_apart);
    return out;
  }

 private:
  static Vec3 sum(const std::array<Vec3, kJoints>& columns, const JointVector& v) {
    Vec3 out(0);
    for (std::size_t k = 0; k < kJoints; ++k) out += v[k] * columns[k];
    return out;
  }
};

/// Solves A x = b subject to the constraint, A symmetric and positive definite, by Cholesky and the constraint's force.
struct JointMobility {
  std::array<JointVector, kJoints> lower;  // Cholesky factor; what is above its diagonal is not read
  JointVector stretch, answer;             // gradient of the constraint, and A⁻¹ times it
  double give = 0;

  /// `matrix`: its lower triangle is read.
  JointMobility(const std::array<JointVector, kJoints>& matrix, const JointVector& gradient)
      : lower(matrix), stretch(gradient) {
    for (std::size_t j = 0; j < kJoints; ++j)
      for (std::size_t i = j; i < kJoints; ++i) {
        double value = matrix[i][j];
        for (std::size_t k = 0; k < j; ++k) value -= lower[i][k] * lower[j][k];
        lower[i][j] = i == j ? std::sqrt(value) : value / lower[j][j];
      }
    answer = free(gradient);
    give = dot(gradient, answer);
  }
  /// With stretch · x = `grows`.
  JointVector solve(const JointVector& b, double grows) const {
    JointVector x = free(b);
    const double pull = (dot(stretch, x) - grows) / give;
    for (std::size_t k = 0; k < kJoints; ++k) x[k] -= pull * answer[k];
    return x;
  }
  /// In row k how all joints move under a unit torque at joint k: the bits of solve(). The innermost loops are over
  /// the torques, so that no division waits for that of another torque.
  std::array<JointVector, kJoints> columns() const {
    std::array<JointVector, kJoints> x{}, out;  // x: row of a joint, column of a torque
    for (std::size_t i = 0; i < kJoints; ++i) {
      x[i][i] = 1;
      for (std::size_t j = 0; j < i; ++j) take(x[i], lower[i][j], x[j]);
      for (double& value : x[i]) value /= lower[i][i];
    }
    for (std::size_t i = kJoints; i-- > 0;) {
      for (std::size_t j = i + 1; j < kJoints; ++j) take(x[i], lower[j][i], x[j]);
      for (double& value : x[i]) value /= lower[i][i];
    }
    JointVector pull{};
    for (std::size_t i = 0; i < kJoints; ++i) take(pull, -stretch[i], x[i]);
    for (double& value : pull) value /= give;
    for (std::size_t i = 0; i < kJoints; ++i) take(x[i], answer[i], pull);
    for (std::size_t k = 0; k < kJoints; ++k)
      for (std::size_t i = 0; i < kJoints; ++i) out[k][i] = x[i][k];
    return out;
  }

 private:
  static void take(JointVector& from, double times, const JointVector& what) {
    for (std::size_t k = 0; k < kJoints; ++k) from[k] -= times * what[k];
  }
  /// A⁻¹ b, without the constraint.
  JointVector free(JointVector b) const {
    for (std::size_t i = 0; i < kJoints; ++i) {
      for (std::size_t k = 0; k < i; ++k) b[i] -= lower[i][k] * b[k];
      b[i] /= lower[i][i];
    }
    for (std::size_t i = kJoints; i-- > 0;) {
      for (std::size_t k = i + 1; k < kJoints; ++k) b[i] -= lower[k][i] * b[k];
      b[i] /= lower[i][i];
    }
    return b;
  }
};

}  // namespace riffler::pen
