// The devices that Riffler supports: finding and opening them.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "riffler/pen/device.hpp"
#include "riffler/pen/found_device.hpp"
#include "riffler/pen/hid/hid_list.hpp"
#include "riffler/pen/pen_options.hpp"

namespace riffler::pen {

/// All families. The pointers stay valid.
std::vector<const PenFamily*> pen_families();
/// The family that matches a HID device; null if none does.
const PenFamily* family_of(const HidInfo& info);

/// Every HID device, with the exact reason if one does not open, and every device behind a maker's service. Devices of
/// unknown families are not touched. Nothing is commanded.
std::vector<FoundDevice> find_devices();
/// The families that find no device because a program or a library is missing: one entry each, with the reason and the
/// remedy.
std::vector<FoundDevice> find_unavailable();

/// Opens a device. `what`: a path or a kind; a kind opens the first device that can be opened, and "kind:which" the one
/// with that number among those of the kind, that serial number, or that part of its name. "simulated" is always
/// available. Throws OpenError; for a kind, the error of the device that came closest to opening.
std::unique_ptr<Pen> open_pen(std::string_view what, const PenOptions& options = {});

}  // namespace riffler::pen
