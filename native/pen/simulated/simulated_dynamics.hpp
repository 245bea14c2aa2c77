// Dynamics of the pen's two arms and grip under motors, weight, friction and a hand.
//
// The coordinates are the six joint angles, with one constraint: the arms' ends stay the grip's length apart. Kinetic
// energy comes from each joint's inertia, taken as constant (rotors through the square of their gears, and links, whose
// posture-dependent part is the smaller one), and from the grip, a rigid body with a mass and an inertia perpendicular
// to its length. Its rotation about its own axis has no inertia: no motor acts on it and it stores no energy.
//
// A step is kick, drift, kick. The drift is RATTLE (Andersen, J. Comput. Phys. 52, 1983; Hairer, Lubich and Wanner,
// "Geometric Numerical Integration", 2nd ed., VII.1.4) of angles and grip together: free motion, symplectic, second
// order, with the exact grip length. All forces act in the kicks: viscous ones by the implicit midpoint rule, dry
// friction as an impulse that either brings a joint to rest or has its full magnitude, so that a pen at rest stays at
// rest.
#pragma once

#include <array>
#include <optional>

#include "pen/simulated/joint_mobility.hpp"
#include "riffler/pen/arms/kinematics.hpp"
#include "riffler/pen/arms/motors.hpp"

namespace riffler::pen {

/// The rotation vector of the shortest rotation between two unit vectors; zero for opposite ones.
Vec3 turn_between(const Vec3& from, const Vec3& to) noexcept;

/// Loads on the pen during a step. Wrench and damping are about the grip's pivot, in the pose frame.
struct PenLoad {
  MotorTorques motors{};  ///< N·mm at the motors
  bool brake = false;     ///< windings shorted
  Wrench wrench{};
  /// A spring that pulls the grip to `aim`, up to its strength: N/mm, N·mm/rad; N, N·mm.
  haptics::Bounds stiffness{0, 0}, strength{0, 0};
  Pose aim{};
  haptics::Bounds damping{0, 0};  ///< N·s/mm, N·mm·s/rad: against motion other than `drift`
  Twist drift{};
  double mass = 0, inertia = 0;  ///< kg, kg·mm² perpendicular to the grip: of what holds it
  double borne = 0;              ///< fraction of the pen's weight that is supported, 0 to 1
};

/// Energy accounts in N·mm since the pen was placed. Kinetic + potential = motors + hand + borne − lost, up to the
/// error of the method.
struct PenEnergy {
  double kinetic = 0, potential = 0;
  double motors = 0;  ///< done by the motors
  double hand = 0;    ///< done by wrench, spring and damping of the load
  double borne = 0;   ///< done by the support of weight
  double lost = 0;    ///< lost to friction, brake and stops
};

class PenDynamics {
 public:
  /// Starts at home, at rest. `geometry`: the real pen, with its home posture consistent with the grip's length.
  explicit PenDynamics(const PenGeometry& geometry);

  /// Places the pen at a pose, at rest, and resets the accounts. Returns false and changes nothing if the pen does not
  /// reach it.
  bool place(const Pose& pose);
  /// Advances by `seconds`, at most 1 ms.
  void step(const PenLoad& load, double seconds);

  const PenKinematics& kinematics() const { return pen_; }
  const PenPosture& posture() const { return posture_; }
  const JointAngles& rates() const { return rates_; }  ///< rad/s
  PenSpeed speed() const { return pen_.speed(posture_, rates_); }
  PenEnergy energy() const;

 private:
  struct Free {
    JointReach reach;
    JointMobility mobility;
  };
  struct Loaded {
    double time;
    haptics::Bounds damping;
    bool brake;
    JointReach reach;
    JointMobility mobility;
    JointVector drags, weight, stops;
    std::array<JointVector, kJoints> columns;  // of the mobility
  };
  const Free& free();
  const Loaded& loaded(const PenLoad& load, double time);
  void forget_posture();
  JointMobility mobility(const JointReach& reach, const PenLoad* load, double time) const;
  JointVector drag(const PenLoad& load) const;
  JointVector stop_torques() const;
  JointVector weight_torques() const;
  Wrench hand(const PenLoad& load) const;
  JointVector pushed(const JointReach& reach, const Wrench& wrench) const;
  double kinetic() const;
  double potential() const;
  void hold(const PenLoad& load);
  void kick(const PenLoad& load, double time);
  void drift(double time);

  PenKinematics pen_;
  JointVector inertia_{}, viscous_{}, coulomb_{}, brake_{};  // at the joints: N·mm·s², N·mm·s/rad, N·mm
  JointVector low_{}, high_{};                               // rad
  double grip_mass_, grip_inertia_;                          // N·s²/mm, N·mm·s²
  PenPosture posture_{};
  JointAngles rates_{};
  double held_mass_ = 0, held_inertia_ = 0;  // units as for the grip
  std::optional<Free> free_;                 // at posture_ with the held mass
  std::optional<Loaded> loaded_;             // of the last kick, if it was there
  JointVector rubbing_{};                    // dry friction of the last kick, N·mm: start of the next search
  PenEnergy account_{};
};

}  // namespace riffler::pen
