// A haptic device against a virtual wall: masses, friction and damping in continuous time, an encoder with steps, and a
// force that is computed at samples and held between them. Deterministic; shares nothing with the theory of
// docs/stability.md, which it is there to check. With up to five coordinates, coupled by mass, damping and the wall.
#pragma once

#include <optional>
#include <vector>

#include "riffler/haptics/passivity.hpp"
#include "stress/matrix.hpp"

namespace riffler::stress {

using Column = std::vector<double>;

/// Units: N, mm, s in the first three coordinates, N·mm, rad, s in the others.
struct WallDevice {
  double period = 1e-3;
  Matrix mass, damping;         // symmetric, positive definite; damping may be semidefinite
  Column friction, resolution;  // Coulomb friction and encoder step of each coordinate; 0 is none

  int coordinates() const { return mass.rows(); }
};

/// One coordinate: mass N·s²/mm, damping N·s/mm, friction N, resolution mm.
WallDevice wall_device(double mass, double damping, double friction = 0, double resolution = 0);

/// f = −normal · (stiffness · d + damping · ḋ) at d = normal · x, with x as measured and ḋ from two samples.
struct SimulatedWall {
  Column normal;
  double stiffness = 0, damping = 0;
  bool one_sided = false;  // no force for d < 0
  double most = 0;         // N: the wall's force goes no further; 0: no limit
};

/// What runs at samples: encoder, wall, and the passivity controller if there is one.
class RenderedWall {
 public:
  RenderedWall(const WallDevice& device, const SimulatedWall& wall,
               const std::optional<haptics::PassivitySettings>& settings);
  /// The force to hold from now on, for the true position at this sample.
  const Column& sample(const Column& position);
  const Column& held() const { return held_; }
  const Column& measured() const { return measured_; }
  const haptics::Passivity* passivity() const { return passivity_ ? &*passivity_ : nullptr; }

 private:
  void measure(const Column& position);

  WallDevice device_;
  SimulatedWall wall_;
  Column measured_, previous_, held_;
  bool first_ = true;
  std::optional<haptics::Passivity> passivity_;
  haptics::Capability capability_;
};

/// The device let go, or held by a hand that is a spring to the origin, a damper and a force.
struct WallHand {
  Matrix stiffness, damping;  // empty is none
};

class WallSimulation {
 public:
  WallSimulation(const WallDevice& device, const WallHand& hand, const SimulatedWall& wall,
                 const std::optional<haptics::PassivitySettings>& settings = {});
  void place(const Column& position, const Column& velocity);
  /// Samples, then advances by one period with the force held and `hand` (N, N·mm).
  void tick(const Column& hand);

  const Column& position() const { return position_; }
  const Column& velocity() const { return velocity_; }
  const RenderedWall& rendered() const { return rendered_; }
  /// N·mm that the held forces delivered, by true and by measured positions: summed in long double, apart from the
  /// controller's own account.
  long double delivered() const { return delivered_; }
  long double measured_delivered() const { return measured_delivered_; }
  /// N·mm; kinetic, and in the hand's spring.
  double mechanical_energy() const;

 private:
  void advance(const Column& force);
  bool sticks(const Column& force) const;
  void rub(double time);

  WallDevice device_;
  WallHand hand_;
  RenderedWall rendered_;
  bool rubs_;
  int parts_;             // per period: 1 without friction, where the exact solution needs no smaller
  Matrix state_, input_;  // (x, v) after a part: state_ · (x, v) + input_ · force
  Column position_, velocity_;
  bool moving_ = false;
  long double delivered_ = 0, measured_delivered_ = 0;
};

}  // namespace riffler::stress
