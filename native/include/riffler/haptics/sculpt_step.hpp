// The haptic step: a tool that follows the hand through a virtual coupling, cuts, and is held by what it must not
// enter.
#pragma once

#include <optional>

#include "riffler/collide/collider.hpp"
#include "riffler/haptics/balance.hpp"
#include "riffler/haptics/coupling.hpp"
#include "riffler/haptics/settings.hpp"
#include "riffler/sweep/move_carver.hpp"

namespace riffler::haptics {

struct SculptSettings {
  CouplingSettings coupling;
  std::optional<double> memory{};  ///< mm of way over which resistance is learnt; without one memory_for
  double damping = 0;              ///< N·s/mm on a cutter in the cut: of its stock's material
  int parts = 1;                   ///< of which a step consists, each with a cut of its own
  int queries = 2;                 ///< of obstacles in each part, at most
  double settled = 1e-3;           ///< mm: a pose that changes less by what a query found is not asked about again
  Bounds rest{0.02, 2e-3};         ///< mm, rad that it moves from rest in one, while the grip stands
  Bounds most{2, 0.2};             ///< mm, rad that the tool moves in a step
  double missed = 0.05;  ///< mm of depth that a query may miss, a tenth of it always; else the tool stays where it is
  std::optional<double> budget{};  ///< s for a step; without one a step is the same on any machine

  /// std::invalid_argument naming the field.
  void validate() const;
};

/// The tool has no mass: at the end of every part of a step the coupling's pull, the material's resistance and the
/// contact force balance (Balance). The resistance is a damper from the last cuts (Resistance), whose force the next
/// cut then confirms: only the area of the cut is old, not the speed, so the step is stable for any removal constant.
/// In a contact the tool is where a Newton step from the last query leads: on what it touches, as a god-object is
/// (Zilles and Salisbury 1995), but as deep as the surfaces' own stiffness lets it.
class SculptStep {
 public:
  struct Result {
    Wrench on_grip;          ///< N, N·mm about the grip's point: the coupling's
    Pose tool;               ///< at the step's end
    Wrench on_tool;          ///< N, N·mm about its tip: what is cut resists so; of the last part that cut
    double removed = 0;      ///< mm³
    double depth_bound = 0;  ///< mm: the tool is surely no deeper in anything it must not enter
    int cuts = 0, queries = 0;
    bool held = false;       ///< a query ran out of time, and the tool was not moved
    bool shortened = false;  ///< parts were made into one to keep the budget
  };

  /// Validates the settings. `stock` to cut with this very tool, `obstacles` to stay out of: either may be missing;
  /// both must outlive this.
  SculptStep(const SculptSettings& settings, const Tool& tool, sweep::MoveCarver* stock,
             const collide::Collider* obstacles);

  /// The tool stands here, and at rest; so does the grip. What of the stock it stands in goes with the next cut,
  /// unfelt.
  void place(const Pose& pose);

  /// The grip, in the frame of the part (Workspace), went here in dt s, with this twist about its point at the end. The
  /// first call after `place` starts from there. dt ≤ 0 or numbers that are not finite move nothing and give no force.
  /// Without `cutting` the stock is as air.
  Result step(const Pose& grip, const Twist& twist, double dt, bool cutting = true);

  /// std::invalid_argument naming the field; then nothing is changed.
  void set_coupling(const CouplingSettings& coupling);

  const Pose& tool() const { return tool_; }
  /// What touched the tool at the last query.
  const collide::Contact& contact() const { return contact_; }
  Damper resistance() const { return resistance_.damper(); }

 private:
  struct Part;
  Twist balanced(const Part& part) const;
  Bounds most_of(const Pose& grip, double share, double dt) const;
  Twist advance(const Part& part, Result& result);
  bool look(const Twist& way, const Part& part, Result& result);
  void cut(const Pose& to, const Twist& way, double dt, Result& result);

  SculptSettings settings_;
  collide::Assembly assembly_;
  double cutting_reach_;
  sweep::MoveCarver* stock_;
  const collide::Collider* obstacles_;
  Resistance resistance_;
  Pose tool_, grip_;
  Twist rate_;  // of the tool, per second
  bool fresh_ = true;
  collide::Contact contact_;
  Pose asked_;  // where contact_ is
  bool touching_ = false;
  collide::ContactStiffness slowing_{};
  double bound_ = 0;        // of the depth at tool_
  double cut_seconds_ = 0;  // of the last cut, by the clock
};

}  // namespace riffler::haptics
