#include "riffler/session/force_gate.hpp"

#include "pen/observation.hpp"
#include "riffler/haptics/coupling.hpp"

namespace riffler::session {

haptics::SafetySettings for_device(haptics::SafetySettings settings, const pen::DeviceCapability& device) {
  if (device.has_force()) return settings;
  settings.jump = settings.overspeed = {1e9, 1e9};
  settings.fresh = 1e9;
  return settings;
}

ForceGate::ForceGate(const haptics::LimitSettings& limits, const haptics::PassivitySettings& passivity,
                     const haptics::SafetySettings& safety, const pen::DeviceCapability& device)
    : limits_((limits.validate(), limits)), device_(device), safety_(safety), passivity_(passivity) {
  safety_.switch_on();
}

haptics::ForceState ForceGate::begin(const pen::PenSample& sample, double now, double dt, bool dead_man) {
  if (dt == 0) {
    safety_.interrupt();
    has_grip_ = false;
  }
  const haptics::ForceState state = safety_.observe(pen::observation_of(sample, now, dt, dead_man && !let_go_.load()));
  applied_ = sample.says_applied ? sample.applied : held_;
  if (!sure(state)) {
    has_grip_ = false;
    return state;
  }
  if (has_grip_) {
    const haptics::PoseError moved = haptics::pose_error(sample.pose, last_grip_);
    passivity_.observe(applied_, {moved.translation, moved.rotation}, dt, sample.dissipated - dissipated_);
  }
  dissipated_ = sample.dissipated;
  last_grip_ = sample.pose, has_grip_ = true;
  return state;
}

haptics::SafeWrench ForceGate::release(const pen::PenSample& sample, const Wrench& wanted, double dt) {
  const haptics::Capability push = pushed(device_, sample.pose.axis);
  if (!safety_.falling()) wanted_ = lets_force_through(safety_.state()) ? wanted : Wrench{};
  slewed_ = limited(limits_, push, slewed_, wanted_, {sample.velocity, sample.turning}, dt);
  const Wrench borne = passivity_.control(slewed_, push);
  const haptics::SafeWrench safe = safety_.release(magnitude_gain(limits_, borne) * borne);
  held_ = safe.wrench();
  quiet_.store(!safe.open() || held_ == Wrench{});
  return safe;
}

}  // namespace riffler::session
