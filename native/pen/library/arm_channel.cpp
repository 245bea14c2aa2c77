#include "pen/library/arm_channel.hpp"

namespace riffler::pen {

void SharedArm::set(const ArmTraits& traits) noexcept {
  name.set(traits.name), serial.set(traits.serial), about.set(traits.about);
  own_axis = traits.own_axis, lower = traits.lower, upper = traits.upper;
  force = traits.force, continuous = traits.continuous, torque = traits.torque;
}

ArmTraits SharedArm::traits() const {
  ArmTraits out;
  out.name = name.get(), out.serial = serial.get(), out.about = about.get();
  out.own_axis = own_axis, out.lower = lower, out.upper = upper;
  out.force = force, out.continuous = continuous, out.torque = torque;
  return out;
}

}  // namespace riffler::pen
