// Options for opening a device.
#pragma once

#include <string>

#include "riffler/pen/arms/compensation.hpp"
#include "riffler/pen/driver_settings.hpp"
#include "riffler/pen/models/rate_control.hpp"

namespace riffler::pen {

/// Options of all kinds of devices; each kind reads its own.
struct PenOptions {
  RateSettings rate{};                     ///< for pucks
  std::string geometry = "woodenhaptics";  ///< for the Polhem protocol: "woodenhaptics" or "polhem-1"
  Compensation compensation{};             ///< for Riffler's pen, including the simulated one
  DriverSettings driver{};
};

}  // namespace riffler::pen
