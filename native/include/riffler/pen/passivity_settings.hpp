// Device data for the passivity controller: resolution of the measurement, and guaranteed damping and friction.
#pragma once

#include "riffler/haptics/passivity.hpp"
#include "riffler/pen/arms/compensation.hpp"
#include "riffler/pen/capability.hpp"

namespace riffler::pen {

/// For a device with only a capability: its stated resolutions and no losses. Unknown resolutions are 0.
haptics::PassivitySettings passivity_settings(const DeviceCapability& device);

/// For a two-arm pen: bounds that hold in every posture within its joint and elbow limits and in all directions.
/// Resolution from the counts of all six joints together; damping and friction as described for the motors, minus the
/// compensated fraction. Most postures are better than these bounds: docs/stability.md. Damping and friction are 0 for
/// a pen that was identified: what they take in the posture of the moment is in PenSample::dissipated.
haptics::PassivitySettings passivity_settings(const PenGeometry& pen, const Compensation& share = {});

/// N/s and N·mm/s by which the wrench of a two-arm pen changes at least, in every posture, while the current that has
/// farthest to go changes by `currents`, A/s, and the others in proportion: the limit of the pen's firmware.
haptics::Bounds slowest_change(const PenGeometry& pen, double currents);

}  // namespace riffler::pen
