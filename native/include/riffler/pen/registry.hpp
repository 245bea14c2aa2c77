// The HID devices that Riffler supports: finding and opening them.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "riffler/pen/arms/compensation.hpp"
#include "riffler/pen/device.hpp"
#include "riffler/pen/driver_settings.hpp"
#include "riffler/pen/hid/hid_list.hpp"
#include "riffler/pen/hid/open_error.hpp"
#include "riffler/pen/models/rate_control.hpp"

namespace riffler::pen {

class HidModel;
class Transport;

/// Options for opening a device.
struct PenOptions {
  RateSettings rate{};                     ///< for pucks
  std::string geometry = "woodenhaptics";  ///< for the Polhem protocol: "woodenhaptics" or "polhem-1"
  CompensationShares compensation{};       ///< for Riffler's pen, including the simulated one
  std::optional<std::uint64_t> seed{};     ///< for the simulated pen: true values drawn at random around the described
  bool real_time = true;                   ///< for the simulated pen: false, as fast as the machine computes
  DriverSettings driver{};
};

/// A family of HID devices.
struct PenFamily {
  const char* kind;
  const char* what;
  bool (*matches)(const HidInfo& info);
  /// Whether a search for devices may open this family. False where devices of other makers share the numbers and
  /// are indistinguishable: such a device is opened only by its kind. Pushing the motors of an unknown device is
  /// no acceptable test.
  bool opened_by_search;
  std::unique_ptr<HidModel> (*make)(Transport& transport, const HidInfo& info, const PenOptions& options);
};

/// All families.
std::span<const PenFamily> pen_families();
/// The family that matches a device; null if none does.
const PenFamily* family_of(const HidInfo& info);

/// A HID device found by a search.
struct FoundDevice {
  HidInfo info;
  const PenFamily* family = nullptr;  ///< null: not supported by Riffler
  bool was_opened = false;            ///< opened and identified; otherwise only permission was checked
  OpenProblem problem = OpenProblem::None;
  std::string text;        ///< why it does not open, and the remedy
  std::string capability;  ///< what is sensed and pushed; only for opened devices
  std::string about;
};

/// Every HID device, with the exact reason if one does not open. Devices of unknown families are not touched.
std::vector<FoundDevice> find_devices();

/// Opens a device. `what`: a path or a kind; a kind opens the first device that can be opened. "simulated" is always
/// available. Throws OpenError; for a kind, the error of the device that came closest to opening.
std::unique_ptr<Pen> open_pen(std::string_view what, const PenOptions& options = {});

}  // namespace riffler::pen
