// The HID devices that Riffler knows, those that are plugged in, and how one is opened.
#pragma once

#include <memory>
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

struct PenOptions {
  RateSettings rate{};                     ///< of pucks
  std::string geometry = "woodenhaptics";  ///< of the Polhem protocol: "woodenhaptics" or "polhem-1"
  Compensation compensation{};             ///< of Riffler's pen, the simulated one too
  DriverSettings driver{};
};

struct PenFamily {
  const char* kind;
  const char* what;
  bool (*matches)(const HidInfo& info);
  /// Whether the search for devices may open one. False where other makers' devices have the same numbers and nothing
  /// in them tells which it is: such a device is opened only by the name of its kind. Pushing a stranger's motors is no
  /// test.
  bool opened_by_search;
  std::unique_ptr<HidModel> (*make)(Transport& transport, const HidInfo& info, const PenOptions& options);
};

std::span<const PenFamily> pen_families();
/// Null if none claims it.
const PenFamily* family_of(const HidInfo& info);

struct FoundDevice {
  HidInfo info;
  const PenFamily* family = nullptr;  ///< null: not a device for Riffler
  bool was_opened = false;            ///< and asked who it is; otherwise only whether it may be opened
  OpenProblem problem = OpenProblem::None;
  std::string text;        ///< why it does not open, and what to do
  std::string capability;  ///< of those that opened: what is sensed and pushed
  std::string about;
};

/// Every HID device, and exactly why one does not open. Those that no family claims are not touched.
std::vector<FoundDevice> find_devices();

/// `what` is a path or a kind: of a kind, the first that opens; "simulated" is one, too, and is always there. Throws
/// OpenError; for a kind, of the device that came nearest to opening.
std::unique_ptr<Pen> open_pen(std::string_view what, const PenOptions& options = {});

}  // namespace riffler::pen
