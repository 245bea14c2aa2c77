// What the passivity controller may take for sure of a device: how finely it measures, and what it takes from the hand.
#pragma once

#include "riffler/haptics/passivity.hpp"
#include "riffler/pen/arms/compensation.hpp"
#include "riffler/pen/capability.hpp"

namespace riffler::pen {

/// Of a device that only says what it senses: resolutions as said, and no losses. What is not said is 0.
haptics::PassivitySettings passivity_settings(const DeviceCapability& device);

/// Of a pen of two arms, with bounds that hold in every posture that its joints and elbows allow, in all directions:
/// resolution from the counts of all six joints together, damping and friction from the motors' as described, less what
/// is made up for. Bounds, so the pen itself has more to give in most postures: docs/stability.md.
haptics::PassivitySettings passivity_settings(const PenGeometry& pen, const Compensation& share = {});

}  // namespace riffler::pen
