// Energy that the friction of an identified pen's joints certainly took from a motion.
#pragma once

#include <array>

#include "pen/arms/certain_friction.hpp"
#include "riffler/geom/vec.hpp"
#include "riffler/pen/arms/compensation.hpp"

namespace riffler::pen {

/// Damping of the grip's pivot in a posture (N·s/mm, pose frame): the smallest force per speed along a direction n,
/// with all other motion free, is 1 / (nᵀ D⁻¹ n). D = Σ Gᵀ J⁻ᵀ C J⁻¹ G over both arms, of which this is the Schur
/// complement of the translations: G maps the grip's motion to an arm's end, J the arm's joints, C is their viscous
/// friction as certain_friction. Zero in a singular posture and for a pen that was not identified.
Mat3 pivot_damping(const PenKinematics& pen, const PenPosture& posture) noexcept;

/// Adds up, joint by joint, what friction took: at least c |φ| + v φ² / t for a motor's turn of φ in the time t, in
/// every posture and on every path (the path is no shorter than the turn; by Cauchy–Schwarz, no motion over φ loses
/// less to damping than the steady one). The share that the motors make up for is left out. Allocates nothing.
class JointLosses {
 public:
  JointLosses(const PenGeometry& pen, const Compensation& share) noexcept;

  /// N·mm since the last call that are certain. `time`: s on the device's clock.
  double add(const EncoderCounts& raw, double time) noexcept;
  /// The next counts are the first: after a gap or a homing.
  void clear() noexcept { begun_ = false; }

 private:
  struct Joint {
    double coulomb, viscous;  // N·mm, N·mm·s/rad
    double turn;              // rad of the motor per count
    std::int32_t from = 0;    // counts at the last credit
    double since = 0;         // s
  };
  std::array<Joint, kPenChannels> joints_{};
  bool begun_ = false;
};

}  // namespace riffler::pen
