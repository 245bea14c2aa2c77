// A weight that hangs on the simulated pen's grip by a thread: it pulls down, and swings when the grip moves.
#pragma once

#include "riffler/geom/vec.hpp"
#include "riffler/haptics/wrench.hpp"
#include "riffler/pen/arms/kinematics.hpp"

namespace riffler::pen {

/// m/s², by which a mass is turned into the weight that an identification knows.
inline constexpr double kStandardGravity = 9.80665;

class SimulatedWeight {
 public:
  /// Hangs `mass` (kg; 0 removes it) on the grip's axis, `hook` mm from the pivot towards the tool's tip, at rest below
  /// that point at the next call of pull. Nothing changes if both are as before. Throws std::invalid_argument for a
  /// mass outside 0 to 2 kg or a hook that is not finite.
  void hang(double mass, double hook);
  double mass() const { return mass_; }
  double hook() const { return hook_; }

  /// The wrench on the grip about its pivot (pose frame) for the next `dt` s. Moves the weight by that time.
  Wrench pull(const PenKinematics& pen, const PenPosture& posture, const PenSpeed& speed, double dt);

 private:
  double mass_ = 0, hook_ = 0;  // kg, mm
  bool hangs_ = false;          // place_ is valid
  Vec3 place_{0}, speed_{0};    // mm, mm/s
};

}  // namespace riffler::pen
