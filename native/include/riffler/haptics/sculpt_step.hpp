// The haptic step: a tool that follows the hand through a virtual coupling, cuts, and is held by obstacles.
#pragma once

#include <optional>

#include "riffler/collide/collider.hpp"
#include "riffler/collide/stock_contact.hpp"
#include "riffler/haptics/balance.hpp"
#include "riffler/haptics/coupling.hpp"
#include "riffler/haptics/guide.hpp"
#include "riffler/haptics/settings.hpp"
#include "riffler/sweep/move_carver.hpp"

namespace riffler::haptics {

/// Settings of the haptic step.
struct SculptSettings {
  CouplingSettings coupling;
  std::optional<double> memory{};  ///< mm of travel for Resistance; default: memory_for
  double damping = 0;              ///< N·s/mm on a cutter while it cuts: Material::damping of its stock
  int parts = 1;                   ///< parts of a step, each with its own cut
  int queries = 2;                 ///< obstacle queries per part, at most
  double touch_stiffness = 10;     ///< N/mm³: of the stock that a tool touches without cutting (StockContact)
  double firmness = 1;             ///< contacts hold the tool by so many times their force; the hand feels the coupling
  double settled = 1e-3;           ///< mm: no further query for a pose that the last one changed by less
  Bounds rest{0.02, 2e-3};         ///< mm, rad: largest move from rest per part while the grip stands still
  Bounds most{2, 0.2};             ///< mm, rad: largest move of the tool per step
  double missed = 0.05;  ///< mm: allowed missed_depth_bound of a query, a tenth always; else the tool does not move
  std::optional<double> budget{};  ///< s for a step; without a budget steps are deterministic

  /// Throws std::invalid_argument naming the field.
  void validate() const;
  /// These settings for a tool that moves `scale` times as far as the hand.
  SculptSettings at_tool(double scale) const;
};

/// The tool is massless: at the end of every part of a step, the pull of the coupling, the material's resistance and
/// the contact force balance (Balance). The resistance is a damper estimated from the last cuts (Resistance). Only the
/// area of the cut is old, not the speed, so the step is stable for any removal constant. In contact the tool moves by
/// a Newton step from the last query: it rests on the obstacle like a god-object (Zilles and Salisbury 1995), but sinks
/// in as deep as the surface's own stiffness lets it.
class SculptStep {
 public:
  /// Text for users where Result::held is true.
  static constexpr const char* kHeldText = "the tool waits: how deep it is in the obstacles was not found in time";

  /// The result of one step.
  struct Result {
    Wrench on_grip;          ///< N, N·mm about the grip's point, from the coupling
    Pose tool;               ///< at the end of the step
    Wrench on_tool;          ///< N, N·mm about the tip: cutting resistance in the last part that cut
    double removed = 0;      ///< mm³
    double depth_bound = 0;  ///< mm: upper bound of the tool's depth in obstacles
    int cuts = 0, queries = 0;
    bool touching = false;   ///< the tool touched the stock without cutting
    bool held = false;       ///< a query ran out of time and the tool did not move
    bool shortened = false;  ///< parts were merged to keep the budget
  };

  /// Throws std::invalid_argument for invalid settings. `stock`: the carver of the stock, with this same tool;
  /// `obstacles`: what the tool stays out of; `guide`: what it cannot leave; `touched`: the stock as an obstacle while
  /// the tool does not cut. Each may be null; all must outlive this object.
  SculptStep(const SculptSettings& settings, const Tool& tool, sweep::MoveCarver* stock,
             const collide::Collider* obstacles, Guide* guide = nullptr, const Volume* touched = nullptr);

  /// Places tool and grip at `pose`, at rest. Stock inside the tool there is removed by the next cut without force.
  void place(const Pose& pose);

  /// Moves the grip to pose `grip` in the part frame (Workspace) within `dt` s, with twist `twist` about its point at
  /// the end. The first call after `place` starts from the placed pose. For dt ≤ 0 or values that are not finite
  /// nothing moves and the force is zero. Without `cutting` the tool stays out of `touched`, which must hold what was
  /// cut so far (MoveCarver::publish), and otherwise passes through the stock. A tool that begins within the material,
  /// as after an undo, passes through it until it has left it.
  Result step(const Pose& grip, const Twist& twist, double dt, bool cutting = true);

  /// Call it when `touched` has got new material where the tool may be.
  void refilled() { felt_ = false; }

  /// Throws std::invalid_argument naming the field and then changes nothing.
  void set_coupling(const CouplingSettings& coupling);

  const Pose& tool() const { return tool_; }
  /// The contact found by the last query.
  const collide::Contact& contact() const { return contact_; }
  Damper resistance() const { return resistance_.damper(); }

 private:
  struct Part;
  Twist balanced(const Part& part) const;
  Twist solved(const Balance& balance) const;
  Pose reached(const Twist& way) const;
  Bounds most_of(const Pose& grip, double share, double dt) const;
  Twist advance(const Part& part, Result& result);
  bool look(const Twist& way, const Part& part, Result& result);
  bool look_at_obstacles(const Part& part);
  bool look_at_stock();
  void begin_touch();
  void end_touch();
  void cut(const Pose& to, const Twist& way, double dt, Result& result);

  SculptSettings settings_;
  collide::Assembly assembly_;
  double cutting_reach_;
  sweep::MoveCarver* stock_;
  const collide::Collider* obstacles_;
  Guide* guide_;
  const Volume* touched_;
  std::optional<collide::StockContact> stock_contact_;
  Resistance resistance_;
  Pose tool_, grip_;
  Twist rate_;  // mm/s, rad/s: of the tool
  bool fresh_ = true;
  collide::Contact contact_;
  Pose asked_;  // pose of contact_
  bool touching_ = false;
  bool felt_ = false;  // the stock counts: the tool was out of it
  double sunk_ = 0;    // mm: mean depth of the stock in the tool at asked_
  collide::ContactStiffness slowing_{};
  double bound_ = 0;        // mm: upper bound of the depth at tool_
  double cut_seconds_ = 0;  // s: measured duration of the last cut
};

}  // namespace riffler::haptics
