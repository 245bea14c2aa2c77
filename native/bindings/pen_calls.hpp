// The functions of riffler.pen.PenGeometry: arrays in, arrays out, one row per moment.
#pragma once

#include "bindings/program_types.hpp"
#include "riffler/pen/arms/kinematics.hpp"
#include "riffler/pen/capability.hpp"

namespace riffler::bindings {

py::array_t<double> forward(const pen::PenKinematics& pen, const Doubles& counts);
py::array_t<double> joints(const pen::PenKinematics& pen, const Doubles& counts);
py::array_t<std::int32_t> counts_of(const pen::PenKinematics& pen, const Doubles& angles);
pen::PenKinematics homed(const pen::PenKinematics& pen, const Doubles& counts, std::int32_t probe);
py::array_t<double> ends(const pen::PenKinematics& pen, const Doubles& counts);
py::array_t<double> jacobian(const pen::PenKinematics& pen, const Doubles& counts);
py::array_t<double> stretch(const pen::PenKinematics& pen, const Doubles& counts);
py::array_t<double> noticed(const pen::PenKinematics& pen, const Doubles& counts);
InverseResult inverse(const pen::PenKinematics& pen, const Doubles& poses);
ArrayPair split(const pen::PenKinematics&, const Doubles& wrenches, const Doubles& apart);
ArrayPair efforts(const pen::PenKinematics& pen, const Doubles& counts, const Doubles& wrenches, const Doubles& at);
CommandPair currents(const pen::PenKinematics& pen, const Doubles& torques);
CommandPair steps(const pen::PenKinematics& pen, const Doubles& torques);
CapabilityResult capability(const pen::PenKinematics& pen);
ChannelList channels(const pen::PenKinematics& pen);
LimitsResult limits(const pen::PenKinematics& pen);
/// Every pen that has a name, with its description.
StringDict pen_list();
DiagnosisResult diagnose(const pen::PenKinematics& pen, const Doubles& counts);

/// Devices without hardware, after PenDevice.
void bind_pointers(py::module_& m);
/// The motion of `riffler pen identify`, after PenDevice.
void bind_pose_follower(py::module_& m);

/// What a device senses and pushes, by the letter of the coordinate.
CoordinateDict to_axes(const pen::DeviceCapability& device);

}  // namespace riffler::bindings
